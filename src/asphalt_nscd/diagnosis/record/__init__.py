"""A diagnosis as files: what was found, what it rests on, and what to do."""

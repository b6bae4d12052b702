"""Which causes are named: the ladder, with its doubts and limits."""

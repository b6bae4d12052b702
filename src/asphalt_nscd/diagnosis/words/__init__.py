"""A diagnosis in plain sentences."""

"""The configuration of a study, and whether it can work."""

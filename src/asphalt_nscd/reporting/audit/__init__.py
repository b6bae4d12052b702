"""Statements of the paper set beside what we find, each with a verdict and its evidence."""

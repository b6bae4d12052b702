"""The core against theory: one module for each theme, whose tests make the rows of the verification table."""

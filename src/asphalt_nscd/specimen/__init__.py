"""Numerical specimens: grading, deposit, trimming, bond network."""

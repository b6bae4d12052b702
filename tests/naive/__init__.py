"""Slow reference implementations in plain Python, written from the equations, not from the kernels."""

"""Figures of the report: one module for each, `draw(...)` from result files to a figure."""

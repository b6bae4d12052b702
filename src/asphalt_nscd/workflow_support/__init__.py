"""Locks, clocks, source stamps and a warm process for Snakemake."""

"""Locks, clocks and source stamps for Snakemake."""

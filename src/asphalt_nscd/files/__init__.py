"""Paths, HDF5 and CSV, digests, and the one sentence that a user reads where a file is wrong."""

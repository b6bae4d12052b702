"""Several campaigns of one machine."""

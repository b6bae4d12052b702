"""Spheres from other programs, and results for them: CSV, LIGGGHTS, YADE, VTK."""

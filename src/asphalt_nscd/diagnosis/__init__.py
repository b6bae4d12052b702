"""What a simulation gets wrong about measurements: residuals, named causes, a ladder, and a verdict."""

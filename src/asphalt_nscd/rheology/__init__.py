"""Linear viscoelastic laws, their shifts and their fits."""

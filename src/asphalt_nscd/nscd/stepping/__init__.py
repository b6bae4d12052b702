"""How bonded systems advance in time by small displacements: full, condensed, reduced, harmonic."""

"""What the predictions state: amplitudes of strain of the two populations, and of the tests at several strains."""

AMPLITUDES = {"ncat": 35e-6, "mixes50": 50e-6}
"""Half of 70e-6 (50 to 75e-6 from peak to peak, AASHTO TP 132) and of 100e-6 (50 to 150e-6, AASHTO TP 62)."""
WEAK = 0.03
"""Stiffness of films in shear over that normal to them, if they are weak in it: films alone contract sideways by 0.33
of what they stretch, as mixes do (0.2 to 0.45). At 1, the usual of facets, they do not contract."""
SEVERAL = 75e-6, 200e-6  # amplitudes of the fatigue tests that are compared
SEVERAL_WEAK = 75e-6, 120e-6  # the same among weak films, where no balance is found at 200e-6

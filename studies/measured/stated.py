"""What the predictions state: amplitudes of strain of the two populations, and of the tests at several strains."""

AMPLITUDES = {"ncat": 35e-6, "mixes50": 50e-6}
"""Half of 70e-6 (50 to 75e-6 from peak to peak, AASHTO TP 132) and of 100e-6 (50 to 150e-6, AASHTO TP 62)."""
SEVERAL = 75e-6, 200e-6  # amplitudes of the fatigue tests that are compared

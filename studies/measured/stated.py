"""What the predictions state: amplitudes of strain of the two populations, and of the tests at several strains.

The tables in `predictions` were made by the commit "Predictions of contacts and softening, published before they are
laid beside a mix", with the stones of the forecast of that day (`studies/measured/contacts.py`, `softening.py` there).
"""

AMPLITUDES = {"ncat": 35e-6, "mixes50": 50e-6}
"""Half of 70e-6 (50 to 75e-6 from peak to peak, AASHTO TP 132) and of 100e-6 (50 to 150e-6, AASHTO TP 62)."""
SEVERAL = 75e-6, 200e-6  # amplitudes of the fatigue tests that are compared

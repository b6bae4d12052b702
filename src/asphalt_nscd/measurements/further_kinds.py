"""Kinds of test that moduli may come from. Apart from `kinds`, which every simulation rests on."""

from asphalt_nscd.measurements.kinds import TEST_TYPES

# Of the last two no fault that their apparatus alone can have is in the catalogue of causes.
ALL_KINDS = TEST_TYPES | {
    "four-point bending": "four-point bending of beams (4PB-PR)",
    "indirect tension": "indirect tension of discs (IT-CY)",
}

"""Formats of other programs. Imports nothing, for the command line and the rules ask it."""

# Format: its module and the endings of its files, the usual one first.
FORMATS = {
    "abaqus": ("abaqus", (".inp",)),
    "ansys": ("ansys", (".inp", ".mac", ".dat", ".txt")),
    "comsol": ("comsol", (".txt",)),
    "csv": ("prony_table", (".csv",)),
    "xlsx": ("workbook", (".xlsx",)),
    "mepdg": ("mepdg", (".csv",)),
}
SOLIDS = ("abaqus", "ansys", "comsol")  # programs that want a solid at infinite time

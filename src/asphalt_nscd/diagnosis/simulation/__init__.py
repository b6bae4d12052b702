"""What the numerical specimen shows of a law, and how a diagnosis extends it."""

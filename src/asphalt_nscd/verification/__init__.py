"""The verification study: one module for each theme, whose `checks` are small functions that give rows."""

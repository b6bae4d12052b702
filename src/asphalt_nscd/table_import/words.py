"""The words that laboratories write, from `words.toml`."""

from __future__ import annotations

import re
import tomllib
from importlib.resources import files

WORDS = tomllib.loads(files(__package__).joinpath("words.toml").read_text(encoding="utf-8"))
SAY = {name: tuple(words.split()) for name, words in WORDS["say"].items()}


def pattern(*names: str, before: str = r"(?<!\w)", behind: str = r"(?!\w)") -> re.Pattern[str]:
    """A pattern that finds one of the words that SAY has under these names."""
    words = "|".join(word for name in names for word in SAY[name])
    return re.compile(rf"{before}(?:{words})\b\.?{behind}", re.IGNORECASE)


ABSENT = frozenset(("", *SAY["absent"]))  # cells without a value, in small letters
MEAN, SPREAD = pattern("mean"), pattern("spread")
# In place of a specimen; no more than that, for `Standard 1` may be one.
OF_SPECIMENS = pattern(
    "mean", "spread", before=r"\W*", behind=r"\s*(?:(?:of|de|von|di|van)\s*\d+|[(\[]?%[)\]]?)?"
)
COMPUTED_SHEET = pattern("mean", "spread", "computed", before=r"\W*")

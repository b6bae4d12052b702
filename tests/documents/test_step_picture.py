"""The picture of docs/stepping.md is what its tool draws."""

from __future__ import annotations

import sys
from xml.etree import ElementTree

from workspace import ROOT

sys.path.insert(0, str(ROOT / "tools"))
from step_picture import CHECKS, drawn  # noqa: E402


def test_the_committed_picture_is_the_drawn_one():
    assert (ROOT / "docs/stepping.svg").read_text(encoding="utf-8") == drawn()
    words = [one.text for one in ElementTree.fromstring(drawn()).iter() if one.tag.endswith("text")]
    assert all(part in words for check in CHECKS for part in check) and words.count("no") == len(CHECKS)

"""README.md and the pages of docs/: short, linked, and with tables that a rule makes and a page can show."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest
import yaml

from asphalt_nscd.reporting.published_tables import BLOCKS, shown

ROOT = Path(__file__).parents[2]
DOCS = [f"docs/{path.name}" for path in sorted((ROOT / "docs").glob("*.md"))]
PAGES = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "config/README.md", *DOCS]
WIDEST = 120
RULES = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "workflow/rules").glob("*.smk"))
TEXTS = {page: (ROOT / page).read_text(encoding="utf-8") for page in PAGES}


def anchors(text: str) -> set[str]:
    """Of the headings, as GitHub and the site make them; code is left out."""
    headings = re.findall(r"^#+ +(.+)$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def blocks() -> list[tuple[str, str, str]]:
    """Page, name and text of each table that a rule makes."""
    found = []
    for page, text in TEXTS.items():
        for name in re.findall(r"^<!-- (?!end )(\w+) -->$", text, re.M):
            found.append((page, name, text.split(f"<!-- {name} -->\n")[1].split(f"<!-- end {name} -->")[0]))
    return found


def test_readme_is_short_and_begins_with_its_commands():
    assert len(TEXTS["README.md"].splitlines()) <= 150
    laboratory, reader = re.findall(r"```sh\n(.*?)```", TEXTS["README.md"], re.S)[:2]
    commands = [line.split("#")[0].strip() for line in laboratory.splitlines()]
    assert commands[0] == "pip install ." and "asphalt-nscd diagnose" in laboratory
    assert [line.split("#")[0].strip() for line in reader.splitlines()] == ["make", "make test", "make smoke"]


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    for target, anchor in re.findall(r"\]\(([^)#\s]*)(?:#([^)\s]*))?", TEXTS[page]):
        if "://" in target:
            continue
        path = (ROOT / page).parent.joinpath(target) if target else ROOT / page
        assert path.exists(), target
        assert not anchor or anchor in anchors(path.read_text(encoding="utf-8")), f"{target}#{anchor}"


def test_every_page_is_in_the_site():
    nav = re.findall(r"[\w-]+\.md", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    assert {page.removeprefix("docs/") for page in DOCS} <= set(nav)


def test_each_block_is_filled_by_a_rule():
    names = [name for _, name, _ in blocks()]
    assert len(names) == len(set(names)) and set(BLOCKS) <= set(names)
    for name in names:
        assert f"--block {name}=" in RULES or f'"{name}"' in RULES, name


@pytest.mark.parametrize(("page", "name", "text"), blocks(), ids=lambda value: str(value)[:40])
def test_tables_are_no_wider_than_a_page(page, name, text):
    widest = max((line for line in text.splitlines() if line.startswith("|")), key=len, default="")
    assert len(widest) <= WIDEST, f"{page}, {name}: {len(widest)} characters, {widest}"


@pytest.mark.parametrize(
    ("block", "table"),
    [
        ("samples", "paper/samples"),
        ("bond_readings", "paper/bond_readings"),
        ("reconstructions", "paper/reconstructions"),
        ("attack", "attack/summary"),
        ("forecast_tried", "forecast/blind_tried"),
        ("forecast_blind", "forecast/blind_overall"),
        ("forecast_left_out", "forecast/blind_left_out"),
        ("forecast_binders", "forecast/blind_binders"),
        ("forecast_slopes", "forecast/slopes"),
        ("benchmark", "benchmark/beside"),
        ("growth", "benchmark/growth"),
    ],
)
def test_layouts_name_columns_that_are_published(block, table):
    """A column that was renamed would vanish from its page without a word."""
    there = set(pd.read_csv(ROOT / f"results/published/{table}.csv").columns)
    for part in BLOCKS[block]:
        assert part.required <= there


@pytest.mark.parametrize(
    ("block", "table"),
    [
        ("attack", "attack/summary"),
        ("machines", "attack/machines_summary"),
    ],
)
def test_no_page_hides_a_goal_that_was_missed(block, table):
    published = pd.read_csv(ROOT / f"results/published/{table}.csv")
    missed = published[published["met"] == "no"]
    met = [line.split("|")[-2].strip() for line in shown(block, missed).splitlines()[2:]]
    assert met == ["no"] * len(missed)


def test_the_site_is_strict():
    site = yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    assert site["strict"] is True and set(site["validation"].values()) == {"warn"}

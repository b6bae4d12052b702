"""A hook of MkDocs (mkdocs.yml): pages that lie outside docs/, and files that pages link to.

The site holds README.md, ARCHITECTURE.md and the like beside docs/, and a copy of each file of the repository
that a page names in a link. Links are rewritten to match, so that pages read the same in a checkout and in the site.
"""

from __future__ import annotations

import ast
import logging
import posixpath
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[1]
PAGES = {
    "README.md": "index.md",
    "ARCHITECTURE.md": "architecture.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changes.md",
    "config/README.md": "configuration.md",
    "data/paper/README.md": "data-of-the-paper.md",
    "data/tutorial/README.md": "data-of-the-tutorial.md",
    "data/ncat/README.md": "data-of-ncat.md",
    "data/mixes50/README.md": "data-of-mixes50.md",
    "data/forecast/README.md": "data-of-forecast.md",
    "plugins/README.md": "plugins.md",
}
MODULES = ROOT / "src/asphalt_nscd"
API = "api/asphalt_nscd"
LINK = re.compile(r"(?<=\]\()([^)#\s]+)")


def on_files(files: Files, *, config: Any) -> Files:
    """Add the pages, and the files that any page links to. A part of the package without a reference is a warning."""
    for room in sorted(path.parent.name for path in MODULES.glob("*/__init__.py")):
        if room != "cli" and files.get_file_from_path(f"api/asphalt_nscd/{room}.html") is None:
            logging.getLogger("mkdocs.hooks").warning(f"docs/api lacks asphalt_nscd.{room}; run make api.")
    files.append(File.generated(config, "reference.md", content=_reference([file.src_uri for file in files])))
    for path, name in PAGES.items():
        files.append(File.generated(config, name, abs_src_path=str(ROOT / path)))
    for page in list(files.documentation_pages()):
        for target in _targets(page.src_uri, page.content_string):
            if files.get_file_from_path(_in_site(target)) is None and (ROOT / target).is_file():
                files.append(File.generated(config, target, abs_src_path=str(ROOT / target)))
    return files


def on_page_markdown(markdown: str, *, page: Any, config: Any, files: Files) -> str:
    """Point links at places in the site instead of the repository."""
    folder = posixpath.dirname(page.file.src_uri) or "."

    def moved(match: re.Match[str]) -> str:
        target = _in_repository(page.file.src_uri, match[0])
        return match[0] if target is None else posixpath.relpath(_in_site(target), folder)

    return LINK.sub(moved, markdown)


def _reference(pages: list[str]) -> str:
    """A table of the rooms of the package: what each is for, and its modules."""
    rows = []
    for room in sorted(path.parent for path in MODULES.glob("*/__init__.py")):
        modules = [page for page in pages if page.startswith(f"{API}/{room.name}/")]
        named = ", ".join(
            f"[{posixpath.splitext(page)[0].split('/', 3)[3]}]({page})" for page in sorted(modules)
        )
        meaning = ast.get_docstring(ast.parse((room / "__init__.py").read_text(encoding="utf-8"))) or ""
        if room.name != "cli":
            rows.append(f"| [{room.name}]({API}/{room.name}.html) | {meaning.splitlines()[0]} | {named} |")
    head = ["# Reference of modules", "", f"[What a user imports]({API}.html), and the rooms behind it:", ""]
    return "\n".join([*head, "| room | what it holds | modules |", "|---|---|---|", *rows, ""])


def _targets(page: str, text: str) -> Iterator[str]:
    for link in LINK.findall(text):
        if target := _in_repository(page, link):
            yield target


def _in_repository(page: str, link: str) -> str | None:
    """The path of a link's target below the root of the repository, None for an address."""
    if "://" in link or link.startswith("mailto:"):
        return None
    source = next((path for path, name in PAGES.items() if name == page), f"docs/{page}")
    return posixpath.normpath(posixpath.join(posixpath.dirname(source), link))


def _in_site(target: str) -> str:
    return PAGES.get(target, target.removeprefix("docs/"))

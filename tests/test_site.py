"""The documentation as a site: every page has its place, and nothing is loaded from elsewhere."""

import re
from pathlib import Path

import pytest

from tools.docs.build import outside_loads
from tools.docs.hooks import on_page_content, on_page_markdown

ROOT = Path(__file__).parents[1]


def test_every_page_has_a_place() -> None:
    named = set(re.findall(r": ([\w/-]+\.md)$", (ROOT / "mkdocs.yml").read_text(), flags=re.MULTILINE))
    there = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")}
    assert named == there, "mkdocs.yml (nav) and docs/ differ"


@pytest.mark.parametrize(
    ("page", "found"),
    [
        ('<script src="https://cdn.example/a.js"></script>', ["https://cdn.example/a.js"]),
        ('<link rel="stylesheet" href="//fonts.example/a.css">', ["//fonts.example/a.css"]),
        ("<style>a{background:url('http://b.example/c.png')}</style>", ["http://b.example/c.png"]),
        ('<a href="https://elsewhere.example">read</a><img src="images/here.jpg">', []),
    ],
)
def test_what_a_page_loads_from_elsewhere_is_found(page: str, found: list[str]) -> None:
    assert outside_loads(page) == found


def test_markdown_of_the_repository_becomes_that_of_the_site() -> None:
    assert on_page_markdown("see [the list](../a/B.md#c).") == "see the list (`a/B.md` in the repository)."
    assert on_page_content("a :class:<code>~x.Y</code><p>::</p>") == "a <code>x.Y</code>"

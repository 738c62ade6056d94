"""What the documentation's Markdown needs to become a site: it is written to be read in the repository.

mkdocs calls these functions by their names (``hooks`` in mkdocs.yml).
"""

import re
from typing import Any

__all__ = ["on_page_content", "on_page_markdown"]

_OUTSIDE = re.compile(r"\[([^\]]+)\]\(\.\./([^)#\s]+)(?:#[^)\s]*)?\)")
_ROLE = re.compile(r":(?:class|func|meth|data|mod|attr|exc):<code>~?([^<]*)</code>")


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Links to files of the repository outside docs/ become the names of those files."""
    return _OUTSIDE.sub(r"\1 (`\2` in the repository)", markdown)


def on_page_content(html: str, **_: Any) -> str:
    """Sphinx roles of docstrings, as ``:class:`Sequence```, become bare names; ``::`` before code goes."""
    named = _ROLE.sub(r"<code>\1</code>", html)
    return named.replace("<p>::</p>", "").replace("::</p>", ":</p>")

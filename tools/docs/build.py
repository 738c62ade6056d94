"""Build the documentation into build/site and see that it loads nothing from elsewhere.

::

    python -m tools.docs.build
"""

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

SITE = Path("build/site")
LOADS = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src", "video": "src"}
"""What makes a browser fetch something; ``a`` does not."""


class _Loads(HTMLParser):
    """Collects the addresses that a page loads."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = dict(attrs)
        if tag == "link" and values.get("rel") == "canonical":
            return
        address = values.get(LOADS.get(tag, ""))
        if address:
            self.found.append(address)


def outside_loads(page: str) -> list[str]:
    """Addresses beyond the site that an HTML text loads, those of its styles included."""
    parser = _Loads()
    parser.feed(page)
    styled = re.findall(r"url\(\s*['\"]?([^'\")]+)", page)
    return [address for address in (*parser.found, *styled) if re.match(r"(?:[a-z]+:)?//", address)]


def main() -> int:
    """Build and check; return the exit code."""
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--clean"]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    if subprocess.run(command, check=False, env=environment).returncode:
        return 1
    faults = 0
    for path in sorted(SITE.rglob("*")):
        if path.suffix in (".html", ".css"):
            for address in outside_loads(path.read_text(encoding="utf-8")):
                print(f"{path}: loads {address}", file=sys.stderr)
                faults += 1
    pages = len(list(SITE.rglob("*.html")))
    print(f"{pages} pages in {SITE}: open {SITE / 'index.html'}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

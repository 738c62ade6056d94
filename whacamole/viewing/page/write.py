"""Writing the page: a template, the numbers as HTML, the rows as JSON that no name can break out of."""

import base64
import hashlib
import json
import re
from collections.abc import Mapping
from html import escape
from importlib.resources import files
from typing import Any

from whacamole.check.stored import StoredFindings, read_findings
from whacamole.dataset import Dataset, DatasetLayout, open_dataset
from whacamole.dataset.files import write_text
from whacamole.dataset.statistics import Statistics, collect
from whacamole.errors import DatasetError
from whacamole.viewing.page.numbers import numbers_html
from whacamole.viewing.page.rows import COLUMNS, rows_of
from whacamole.viewing.places import Places

__all__ = ["page_html", "write_page"]


def write_page(layout: DatasetLayout, numbers: Statistics | None = None) -> None:
    """Write ``index.html`` of a dataset.

    Args:
        numbers: what the dataset holds; counted anew where they are not given.

    Raises:
        DatasetError: a file of the dataset is missing or broken.
    """
    data = open_dataset(layout.root)
    try:
        found: StoredFindings | str | None = read_findings(layout.root)
    except DatasetError as error:  # no reason to be without a page
        found = str(error)
    counted = collect(data) if numbers is None else numbers
    write_text(Places(layout.root).page, page_html(data, counted, found))


def page_html(data: Dataset, numbers: Statistics, found: StoredFindings | str | None) -> str:
    """The page as one HTML text that loads nothing but pictures, videos and scenes of the dataset.

    Args:
        found: the outcome of the last audit, why it cannot be read, or None if there was none.
    """
    style, script = _part("page.css"), _part("page.js")
    name = data.layout.root.resolve().name
    rows: Mapping[str, Any] = {
        "columns": COLUMNS,
        "rows": rows_of(data, None if isinstance(found, str) else found),
    }
    values = {
        "policy": _policy(style, script),
        "name": escape(name),
        "style": style,
        "script": script,
        "about": escape(_about(data.index, numbers)),
        "audit": _audit(found),
        "numbers": numbers_html(numbers),
        "rows": _inert(rows),
    }
    return re.sub(r"<!--@(\w+)-->|@@(\w+)@@", lambda match: values[match[1] or match[2]], _part("page.html"))


def _part(name: str) -> str:
    return files("whacamole.viewing.page").joinpath(name).read_text(encoding="utf-8")


def _inert(value: Any) -> str:
    """JSON that may stand inside a script element, whatever words it holds."""
    text = json.dumps(value, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _policy(style: str, script: str) -> str:
    """The content security policy: this style, this script, files beside the page, and nothing else."""
    digests = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in (style, script)]
    return (
        f"default-src 'none'; img-src 'self' file:; media-src 'self' file:; "
        f"style-src 'sha256-{digests[0]}'; script-src 'sha256-{digests[1]}'; "
        "base-uri 'none'; form-action 'none'"
    )


def _about(index: Mapping[str, Any], numbers: Statistics) -> str:
    versions = index.get("versions")
    version = versions.get("whacamole", "") if isinstance(versions, Mapping) else ""
    models = ", ".join(numbers.body_models) or "none"
    seconds = numbers.seconds
    length = f"{seconds:.1f} seconds" if seconds < 120 else f"{seconds / 60:,.1f} minutes"
    return (
        f"{numbers.sequences:,} sequences, {numbers.frames:,} frames, {numbers.instances:,} instances "
        f"(a person in an image), {length}. Made by whacamole {version}, "
        f"seed {index.get('seed', 'not stated')}, body model {models}."
    )


def _audit(found: StoredFindings | str | None) -> str:
    """What the last audit said, as HTML."""
    if isinstance(found, str):
        return f"<p class=finding>{escape(found)}</p>"
    if found is None:
        commands = "<code>whacamole check</code>, then <code>whacamole page</code>"
        return f"<p class=note>Not audited yet: {commands}.</p>"
    audited = f"Audit of {found.sequences:,} sequences, {found.frames:,} frames"
    old = "" if found.current else " The dataset has changed since: audit it again."
    if not found.lines:
        return f"<p class=note>{audited}: nothing wrong.{old}</p>"
    lines = "".join(f"<li>{escape(line.text)}</li>" for line in found.lines[:200])
    more = f"<p>and {len(found.lines) - 200:,} more</p>" if len(found.lines) > 200 else ""
    return (
        f"<details class=bad><summary>{audited}: {len(found.lines):,} findings.{old}</summary>"
        f"<ul>{lines}</ul>{more}</details>"
    )

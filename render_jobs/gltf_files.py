"""The files a glTF scene refers to: they lie beside it, or it is refused."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from render_jobs.errors import RenderJobError

GLB_MAGIC, JSON_CHUNK = b"glTF", b"JSON"


def check_gltf(file: Path) -> None:
    """Refuse a damaged file and one whose buffers or images lie outside its folder.

    Raises:
        RenderJobError: the message does not name the file.
    """
    root = file.parent.resolve()
    document = _document(file)
    for kind in ("buffers", "images"):
        for entry in document.get(kind, []):
            uri = entry.get("uri") if isinstance(entry, dict) else None
            if uri is None or str(uri).startswith("data:"):
                continue
            target = (root / unquote(str(uri))).resolve()
            if "://" in str(uri) or not target.is_relative_to(root):
                raise RenderJobError(f"refers to {uri}, outside its folder; put it beside the file")
            if not target.is_file():
                raise RenderJobError(f"refers to {uri}, which is missing; put it beside the file")


def _document(file: Path) -> dict[str, Any]:
    """The JSON part of a ``.gltf`` or ``.glb`` file."""
    content = file.read_bytes()
    try:
        if file.suffix.lower() == ".glb":
            if content[:4] != GLB_MAGIC or content[16:20] != JSON_CHUNK:
                raise ValueError("it does not begin as a .glb file does")
            (length,) = struct.unpack("<I", content[12:16])
            if struct.unpack("<I", content[8:12])[0] > len(content):
                raise ValueError("it is cut short")
            content = content[20 : 20 + length]
        document = json.loads(content)
    except (ValueError, struct.error) as error:
        raise RenderJobError(f"is damaged ({error}); export it again") from error
    if not isinstance(document, dict):
        raise RenderJobError("is no glTF scene; export it again")
    return document

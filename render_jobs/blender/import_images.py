"""Images of a user's scene file: copied if they are packed or lie beside the file, else left out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

KINDS = ((b"\x89PNG", ".png"), (b"\xff\xd8\xff", ".jpg"))
MAPS = ((b"v/1\x01", ".exr"), (b"#?", ".hdr"))


class Images:
    """Copies the images of one file, each once.

    Attributes:
        notes: what was left out, a line each.
    """

    def __init__(self, root: Path, scratch: Path) -> None:
        self._root = root
        self._scratch = scratch
        self._copies: dict[str, Path | None] = {}
        self._mappings: dict[str, NDArray[np.float64]] = {}
        self.notes: list[str] = []

    def texture(self, image: Any) -> Path | None:
        """A PNG or JPEG copy of a texture, or None where it cannot be had."""
        return self._copy(image, KINDS, "PNG", ".png")

    def surroundings(self, image: Any) -> Path | None:
        """An OpenEXR or Radiance copy of an environment map, or None where it cannot be had."""
        return self._copy(image, MAPS, "OPEN_EXR", ".exr")

    def note(self, text: str) -> None:
        """Add a note, once."""
        if text not in self.notes:
            self.notes.append(text)

    def set_mapping(self, material: str, matrix: NDArray[np.float64]) -> None:
        """Keep how a material moves its texture: ``(2, 3)``, applied to the texture coordinates."""
        self._mappings[material] = matrix

    def mapped(self, material: str, uv: NDArray[np.float32]) -> NDArray[np.float32]:
        """Texture coordinates as the material uses them."""
        matrix = self._mappings.get(material)
        if matrix is None:
            return uv
        moved: NDArray[np.float32] = (uv @ matrix[:, :2].T + matrix[:, 2]).astype(np.float32)
        return moved

    def _copy(
        self, image: Any, kinds: tuple[tuple[bytes, str], ...], file_format: str, suffix: str
    ) -> Path | None:
        if image.name not in self._copies:
            self._copies[image.name] = self._write(image, kinds, file_format, suffix)
        return self._copies[image.name]

    def _write(
        self, image: Any, kinds: tuple[tuple[bytes, str], ...], file_format: str, suffix: str
    ) -> Path | None:
        self._scratch.mkdir(parents=True, exist_ok=True)
        target = self._scratch / f"image-{len(self._copies)}"
        content = self._content(image)
        if content is None:
            return None
        for magic, known in kinds:
            if content.startswith(magic):
                target.with_suffix(known).write_bytes(content)
                return target.with_suffix(known)
        try:
            image.file_format = file_format
            image.save(filepath=str(target.with_suffix(suffix)))
        except RuntimeError:
            self.note(f"image {image.name}: cannot be read; the surface shows its plain colour")
            return None
        return target.with_suffix(suffix)

    def _content(self, image: Any) -> bytes | None:
        """The bytes of the image's file; empty for one made in Blender; None where it is left out."""
        if image.packed_file is not None:
            return bytes(image.packed_file.data)
        if image.source == "GENERATED":
            return b""
        path = Path(bpy.path.abspath(image.filepath, library=image.library)).resolve()
        if image.source != "FILE" or not path.is_relative_to(self._root):
            where = "is no single image" if image.source != "FILE" else "lies outside the file's folder"
            self.note(f"image {image.name}: {where}; pack it into the file or put it beside it")
            return None
        if not path.is_file():
            self.note(f"image {image.name}: {path} is missing; pack it into the file or put it beside it")
            return None
        return path.read_bytes()

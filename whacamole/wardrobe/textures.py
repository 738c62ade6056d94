"""The pictures a person needs, written once each: skin in its tone, eyes, dyed clothes, coloured hair."""

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt
import scipy.special
from PIL import Image

from whacamole.wardrobe import palette
from whacamole.wardrobe.cast import CastMember, Worn
from whacamole.wardrobe.catalogue import Catalogue, Item

JPEG_QUALITY: Final = 93
EYE_SIZE: Final = 256

IRIS_RADIUS: Final = 0.44
PUPIL_RADIUS: Final = 0.17
"""Shares of the eyeball's radius."""

Pixels = npt.NDArray[np.float32]


@dataclass(frozen=True)
class TextureFolder:
    """A folder for textures made to order. Names follow from content, so people and takes can share it."""

    path: Path

    def write(self, stem: str, pixels: Pixels) -> Path:
        """Writes (H, W, 3) as JPEG or (H, W, 4) as PNG, 0..255, and returns the file."""
        data = np.clip(np.rint(pixels), 0, 255).astype(np.uint8)
        digest = hashlib.sha256(data.tobytes()).hexdigest()[:12]
        target = self.path / f"{stem}-{digest}{'.png' if data.shape[2] == 4 else '.jpg'}"
        if not target.is_file():
            self.path.mkdir(parents=True, exist_ok=True)
            part = target.with_name(f".{os.getpid()}.{target.name}")
            image = Image.fromarray(data)
            if data.shape[2] == 4:
                image.save(part, compress_level=1)
            else:
                image.save(part, quality=JPEG_QUALITY)
            part.replace(target)
        return target


def read(path: Path) -> Pixels:
    """Pixels (H, W, 3 or 4) 0..255."""
    with Image.open(path) as image:
        mode = "RGBA" if "A" in image.getbands() else "RGB"
        return np.asarray(image.convert(mode), dtype=np.float32)


def skin_texture(wardrobe: Catalogue, member: CastMember, folder: TextureFolder) -> Path:
    """The member's skin in the member's tone."""
    skin = next(s for s in wardrobe.skins if s.name == member.skin)
    pixels = palette.to_tone(read(wardrobe.texture(skin.diffuse)), skin.tone, palette.skin_tone(member.tone))
    return folder.write(skin.name, pixels)


def item_texture(
    wardrobe: Catalogue, item: Item, worn: Worn, hair_colour: str, folder: TextureFolder
) -> Path:
    """The item's picture in its colours. Only this item's picture changes: a dyed shirt leaves jeans and
    skin alone."""
    source = wardrobe.texture(item.diffuse)
    pixels = read(source)
    if item.colouring == "hair":
        return folder.write(item.name, _hair(item, pixels, hair_colour))
    if item.see_through:
        return folder.write(item.name, pixels)
    if worn.colour is not None:
        return folder.write(item.name, palette.dye(pixels, worn.colour))
    if (worn.hue, worn.saturation, worn.brightness) == (0.0, 1.0, 1.0):
        return source
    return folder.write(item.name, palette.turn_hue(pixels, worn.hue, worn.saturation, worn.brightness))


def _hair(item: Item, pixels: Pixels, colour: str) -> Pixels:
    """Strands keep their light and dark; brows are a little darker than the hair."""
    solid = pixels[..., 3] > 128
    level = float(np.median(palette.luminance(pixels)[solid])) if solid.any() else 0.5
    red, green, blue = palette.HAIR_COLOURS[colour]
    shade = 0.7 if item.slot == "brows" else 1.0
    strands = palette.dye(
        pixels[..., :3],
        (red * shade, green * shade, blue * shade),
        contrast=palette.HAIR_CONTRAST.get(colour, 1.0),
        level=level,
        brightest=2.2,
    )
    return np.concatenate([strands, pixels[..., 3:]], axis=2)


def eye_texture(colour: str, folder: TextureFolder) -> Path:
    """A looking eye: iris with fibres, dark rim and pupil on a veined white; the picture spans the
    eyeball's front."""
    rng = np.random.default_rng(int.from_bytes(hashlib.sha256(colour.encode()).digest()[:4], "little"))
    grid = (np.arange(EYE_SIZE) + 0.5) / EYE_SIZE * 2 - 1
    x, y = np.meshgrid(grid, grid)
    radius, angle = np.hypot(x, y), np.arctan2(y, x) + np.pi
    white = np.array([0.86, 0.83, 0.80]) - np.clip((radius - 0.5) / 0.5, 0, 1)[..., None] * [0.03, 0.12, 0.12]
    fibres = np.interp(angle, np.linspace(0, 2 * np.pi, 241), np.append(rng.normal(0, 1, 240), 0.0))
    ring = 1.25 - 0.7 * np.abs(radius / IRIS_RADIUS - 0.6)
    iris = np.array(palette.EYE_COLOURS[colour]) * (ring * (0.9 + 0.15 * fibres))[..., None]
    iris = np.where((radius > 0.86 * IRIS_RADIUS)[..., None], iris * 0.5, iris)
    image = _blend(white, np.clip(iris, 0, 1), radius, IRIS_RADIUS, 0.012)
    image = _blend(image, np.full(3, 0.01), radius, PUPIL_RADIUS, 0.008)
    return folder.write(f"eye-{colour.replace(' ', '-')}", (255 * image).astype(np.float32))


def _blend(
    outside: npt.NDArray[np.float64],
    inside: npt.NDArray[np.float64],
    radius: npt.NDArray[np.float64],
    edge: float,
    soft: float,
) -> npt.NDArray[np.float64]:
    share = np.asarray(scipy.special.expit((edge - radius) / soft))[..., None]
    mixed: npt.NDArray[np.float64] = outside * (1 - share) + inside * share
    return mixed

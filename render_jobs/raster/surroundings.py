"""What surrounds a job's scene as an image, two ambient colours and a sun: all that a rasteriser can take."""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs.colour import linear
from render_jobs.errors import EngineError
from render_jobs.maps import read_map, solid_angles
from render_jobs.scene import Environment

Floats = NDArray[np.float32]

SKY_SIZE = (128, 256)
BRIGHT = 12.0
"""What outshines the mean of an environment map by this factor is taken for its sun."""


@dataclass(frozen=True)
class Surroundings:
    """An environment split into what a rasteriser can do.

    Attributes:
        image: linear light ``(H, W, 3)``, equirectangular, zenith first, the middle column along +x.
        above, below: mean radiance ``(3,)`` of the two halves.
        sun: the direction towards the brightest part and its irradiance, or None where nothing outshines
            the rest.
    """

    image: Floats
    above: Floats
    below: Floats
    sun: tuple[Floats, Floats] | None


def surroundings_of(environment: Environment) -> Surroundings:
    """Read or paint the environment.

    Raises:
        EngineError: the environment map cannot be had.
    """
    image = _image(environment) * np.float32(environment.strength)
    angle = solid_angles(image.shape[0], image.shape[1])
    sun, rest = _take_sun(image, angle) if environment.kind == "hdri" else (None, image)
    half = image.shape[0] // 2
    above, below = (
        np.average(part.reshape(-1, 3), axis=0, weights=weight.ravel()).astype(np.float32)
        for part, weight in ((rest[:half], angle[:half]), (rest[half:], angle[half:]))
    )
    if environment.backdrop is not None:
        image = np.broadcast_to(np.asarray(linear(environment.backdrop), np.float32), (1, 1, 3))
    return Surroundings(np.ascontiguousarray(image, np.float32), above, below, sun)


def _image(environment: Environment) -> Floats:
    if environment.kind == "color":
        return np.broadcast_to(np.asarray(linear(environment.color), np.float32), (*SKY_SIZE, 3)).copy()
    if environment.kind == "sky":
        return _clear_sky(environment)
    hdri = environment.hdri
    image = read_map(hdri if isinstance(hdri, Path) else _map_of_blender(hdri))
    shift = round(environment.rotation / 360.0 * image.shape[1])
    return np.roll(image, -shift, axis=1)


def _clear_sky(environment: Environment) -> Floats:
    """A gradient from the zenith to a bright horizon and a dim ground, warmer with a low sun."""
    up = np.sin(np.pi * (0.5 - (np.arange(SKY_SIZE[0]) + 0.5) / SKY_SIZE[0]))[:, None]
    low = 1.0 - math.sin(math.radians(max(environment.sun_elevation, 0.0)))
    zenith, noon, evening = (
        np.array([0.16, 0.32, 0.75]),
        np.array([0.75, 0.85, 1.0]),
        np.array([1.0, 0.85, 0.65]),
    )
    horizon = noon + low * (evening - noon)
    sky = horizon + (zenith - horizon) * np.clip(up, 0, 1) ** 0.5
    rows = np.where(up > 0, sky, 0.25 * horizon)
    return np.broadcast_to(rows[:, None], (*SKY_SIZE, 3)).astype(np.float32)


def _map_of_blender(name: str) -> Path:
    """An environment map of Blender's wheel, which need not be able to run for that."""
    spec = find_spec("bpy")
    roots = [Path(place) for place in (spec.submodule_search_locations or [])] if spec else []
    for root in roots:
        for found in sorted(root.glob(f"**/studiolights/world/{name}.exr")):
            return found
    raise EngineError(
        f"environment map {name!r} comes with the package bpy, which is missing: pip install bpy"
    )


def _take_sun(image: Floats, angle: Floats) -> tuple[tuple[Floats, Floats] | None, Floats]:
    """Split off what outshines the rest as one distant light."""
    luminance = image @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    limit = BRIGHT * np.average(luminance, weights=angle)
    bright = luminance > limit
    if not bright.any():
        return None, image
    scale = np.where(bright, limit / np.maximum(luminance, 1e-9), 1.0)[..., None].astype(np.float32)
    excess = (image * (1 - scale) * angle[..., None])[bright]
    height, width = luminance.shape
    row, column = np.nonzero(bright)
    polar, azimuth = np.pi * (row + 0.5) / height, np.pi * (1 - 2 * (column + 0.5) / width)
    rays = np.column_stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
    mean = (rays * excess.sum(axis=1, keepdims=True)).sum(axis=0)
    towards = (mean / np.linalg.norm(mean)).astype(np.float32)
    return (towards, excess.sum(axis=0)), image * scale

"""Light by the user's own environment maps."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from render_jobs import Environment, RenderJobError, Sun
from render_jobs.maps import MAP_SUFFIXES, irradiance_from_above, read_map
from whacamole.stage.stage import Stage

__all__ = ["Hdri", "hdri_files", "lit_by", "read_hdri"]

DAY = 2.1
"""Irradiance of level ground that suits exposure 0: that of Blender's map ``courtyard`` at strength 1."""

WIDEST = 2.2
"""A map is this many times as wide as it is high, at most; equirectangular ones are twice as wide."""


@dataclass(frozen=True)
class Hdri:
    """An environment map.

    Attributes:
        path: the file.
        irradiance: what it throws on level ground at strength 1.
    """

    path: Path
    irradiance: float


def hdri_files(path: Path) -> tuple[Path, ...]:
    """Return the maps that ``path`` stands for: itself, or those in the folder, by name; maybe none."""
    if path.is_file():
        return (path,)
    if not path.is_dir():
        return ()
    return tuple(sorted(file for file in path.iterdir() if file.suffix.lower() in MAP_SUFFIXES))


def read_hdri(path: Path) -> Hdri:
    """Read a map to see how bright it is.

    Raises:
        RenderJobError: it cannot be used; one line names the file.
    """
    if path.suffix.lower() not in MAP_SUFFIXES:
        raise RenderJobError(f"{path}: an environment map ends in {' or '.join(MAP_SUFFIXES)}")
    image = read_map(path)
    if not 2.0 / WIDEST * 2.0 <= image.shape[1] / image.shape[0] <= WIDEST:
        height, width = image.shape[:2]
        raise RenderJobError(f"{path}: {width}×{height} is not equirectangular, twice as wide as high")
    return Hdri(path, max(irradiance_from_above(image), 1e-6))


def lit_by(stage: Stage, hdris: tuple[Hdri, ...], rng: np.random.Generator) -> Stage:
    """Return the stage under one of the maps, turned at random and as bright as a day.

    Only a stage under a sky is changed; rooms and nights keep their lamps.
    """
    if not hdris or stage.environment.kind == "color":
        return stage
    hdri = hdris[int(rng.integers(len(hdris)))]
    environment = Environment(
        kind="hdri",
        hdri=hdri.path,
        rotation=float(rng.uniform(0.0, 360.0)),
        strength=DAY / hdri.irradiance,
    )
    lamps = tuple(light for light in stage.lights if not isinstance(light, Sun))
    return replace(stage, lights=lamps, environment=environment, exposure=0.0)

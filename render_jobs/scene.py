"""What stands in a scene and lights it, as plain values.

Frames: world, metres, right-handed, z up. Colours are sRGB in 0..1, as one would type them in an image
editor; the renderer makes them linear. Nothing here knows a renderer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from render_jobs.errors import RenderJobError

Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
Positive = Annotated[float, Field(gt=0.0)]
NonNegative = Annotated[float, Field(ge=0.0)]
Colour = tuple[Fraction, Fraction, Fraction]
Vector3 = tuple[float, float, float]

HdriName = Literal["city", "courtyard", "forest", "interior", "night", "studio", "sunrise", "sunset"]
"""The environment maps that come with Blender (CC0)."""

HDRI_NAMES: tuple[str, ...] = get_args(HdriName)

MAX_TRACK_ID = 32767
"""The largest object index that Blender keeps."""


class SceneValue(BaseModel):
    """Base of the plain values: immutable, unknown names refused, no NaN."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Material(SceneValue):
    """How a surface looks: the metallic-roughness model that every engine shares.

    ``base_color`` is multiplied with ``base_color_texture`` where there is one. Textures are PNG or JPEG
    files; the base colour is read as sRGB, the normal map as data (OpenGL convention, green up).
    ``alpha_mode`` says what the texture's alpha does: nothing, cut at one half (hair cards; mask and depth
    follow the cut), or blend.
    """

    name: str = "material"
    base_color: Colour = (1.0, 1.0, 1.0)
    base_color_texture: Path | None = None
    alpha_mode: Literal["opaque", "clip", "blend"] = "opaque"
    roughness: Fraction = 0.6
    metallic: Fraction = 0.0
    specular: Fraction = 0.5
    normal_texture: Path | None = None
    normal_strength: NonNegative = 1.0
    subsurface: Fraction = 0.0
    """Weight of light scattered below the surface, with the reddish radii of skin."""
    uv_scale: Positive = 1.0
    """The texture repeats this many times across the unit square of the UV map."""
    emission: Colour = (1.0, 1.0, 1.0)
    emission_strength: NonNegative = 0.0
    emission_lights: bool = True
    """Whether rays are aimed at what glows. Without, it looks lit at no cost in light samples: a shade."""
    double_sided: bool = True


class Sun(SceneValue):
    """Light from infinitely far. ``direction`` is the way the light travels, ``strength`` is in W/m²."""

    kind: Literal["sun"] = "sun"
    direction: Vector3 = (0.3, 0.5, -1.0)
    strength: NonNegative = 3.0
    angle: NonNegative = 0.53
    """Angular diameter in degrees; larger means softer shadows."""
    color: Colour = (1.0, 1.0, 1.0)


class Lamp(SceneValue):
    """A light in the scene. ``position`` and ``target`` in metres; ``size`` is the edge or diameter of the
    source."""

    kind: Literal["area", "point", "spot"] = "area"
    position: Vector3
    target: Vector3 = (0.0, 0.0, 1.0)
    power_w: NonNegative = 100.0
    size: Positive = 1.0
    color: Colour = (1.0, 1.0, 1.0)
    spot_angle: Annotated[float, Field(gt=0.0, lt=180.0)] = 60.0
    """Full opening angle of a spot in degrees."""


class Environment(SceneValue):
    """What surrounds the scene at infinity, and lights it.

    ``color``: one colour. ``sky``: a clear daylight sky without the disc of the sun (add a :class:`Sun`).
    ``hdri``: an environment map, one of :data:`HDRI_NAMES` or the path of an equirectangular ``.exr`` or
    ``.hdr``.
    """

    kind: Literal["color", "sky", "hdri"] = "color"
    color: Colour = (0.75, 0.82, 0.9)
    hdri: HdriName | Path = "courtyard"
    rotation: float = 0.0
    """Degrees about z, counter-clockwise seen from above."""
    strength: NonNegative = 1.0
    sun_elevation: Annotated[float, Field(ge=-10.0, le=90.0)] = 35.0
    """Degrees; where the sun of a ``sky`` stands (its azimuth is ``rotation``, 0 = +x)."""
    backdrop: Colour | None = None
    """A colour the camera sees in place of the environment, which then only lights."""


Light = Annotated[Sun | Lamp, Field(discriminator="kind")]


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface, at rest or moving.

    Attributes:
        name: unique in the job; letters, digits, ``-``, ``_`` and ``.``.
        vertices: float32 ``(V, 3)`` at rest, or ``(T + 2, V, 3)`` for frames −1 … T: the neighbours of the
            first and the last frame give these their motion. World frame, metres.
        faces: int32 ``(F, 3)`` or ``(F, 4)``; ``-1`` in the fourth column marks a triangle among quads.
            Counter-clockwise seen from outside.
        material: how it looks.
        uv: float32 ``(F, k, 2)``, one coordinate a face corner (v up), or None.
        placements: float64 ``(N, 4, 4)`` mesh-to-world transforms; the mesh is drawn once for each, and
            kept in memory once. None means one placement, the identity.
        track_id: the value in the mask; 0 is background.
        smooth: shade with smooth normals.
        subdivision: levels of Catmull-Clark subdivision (drawn only; depth and mask follow the drawn
            surface).
    """

    name: str
    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    material: Material = field(default_factory=Material)
    uv: NDArray[np.float32] | None = None
    placements: NDArray[np.float64] | None = None
    track_id: int = 0
    smooth: bool = True
    subdivision: int = 0

    def __post_init__(self) -> None:
        for name, dtype in (
            ("vertices", np.float32),
            ("faces", np.int32),
            ("uv", np.float32),
            ("placements", np.float64),
        ):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, np.ascontiguousarray(value, dtype=dtype))
        self._check_values()
        self._check_geometry()

    @property
    def animated(self) -> bool:
        """Whether the vertices move."""
        return self.vertices.ndim == 3

    @property
    def num_vertices(self) -> int:
        """The number of vertices, V."""
        return int(self.vertices.shape[-2])

    def frame(self, index: int) -> NDArray[np.float32]:
        """The vertices ``(V, 3)`` of frame ``index``, −1 … T."""
        return self.vertices[index + 1] if self.animated else self.vertices

    def _fail(self, reason: str) -> None:
        raise RenderJobError(f"mesh {self.name!r}: {reason}")

    def _check_values(self) -> None:
        if not self.name or not all(c.isalnum() or c in "-_." for c in self.name):
            self._fail("the name may hold letters, digits, '-', '_' and '.' only")
        if not 0 <= self.track_id <= MAX_TRACK_ID:
            self._fail(f"track_id {self.track_id} is outside 0..{MAX_TRACK_ID}")
        if not 0 <= self.subdivision <= 4:
            self._fail(f"subdivision {self.subdivision} is outside 0..4")
        if self.placements is not None and self.placements.shape[1:] != (4, 4):
            self._fail(f"placements have shape {self.placements.shape}, expected (N, 4, 4)")

    def _check_geometry(self) -> None:
        v, f = self.vertices, self.faces
        if v.ndim not in (2, 3) or v.shape[-1] != 3 or v.shape[-2] < 3:
            self._fail(f"vertices have shape {v.shape}, expected (V, 3) or (T + 2, V, 3)")
        if not np.isfinite(v).all():
            self._fail("vertices hold NaN or infinity")
        if f.ndim != 2 or f.shape[1] not in (3, 4) or len(f) == 0:
            self._fail(f"faces have shape {f.shape}, expected (F, 3) or (F, 4)")
        if f[:, :3].min() < 0 or f.min() < -1 or f.max() >= self.num_vertices:
            self._fail(f"faces name vertices outside 0..{self.num_vertices - 1}")
        if self.uv is not None and self.uv.shape != (*f.shape, 2):
            self._fail(
                f"uv has shape {self.uv.shape}, expected {(*f.shape, 2)}, one coordinate a face corner"
            )


def plain(value: SceneValue) -> dict[str, Any]:
    """The value as JSON data."""
    return value.model_dump(mode="json")

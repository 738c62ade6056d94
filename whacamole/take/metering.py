"""A photographer's light meter: how bright faces will be, and the stops that keep them readable.

Estimated from the take alone, without a renderer, in milliseconds: lamps, sun and sky on every face, the
shadows of what stands about, and a share for what walls and ground throw back. It is a meter, not a renderer:
the shade of hats, hair and other people is left out.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from camera_rigs import World
from render_jobs import Lamp, Sun
from render_jobs.colour import linear, linear_image
from whacamole.body import JOINT_INDEX, unit_vectors
from whacamole.stage import DAY, Stage
from whacamole.wardrobe import skin_tone

__all__ = ["face_irradiance", "face_stops", "metered"]

FLOOR = 0.08
"""Light from a face, white paper in full light being 1, under which it is too dark to read."""

CEILING = 0.7
"""Metering for a dark face leaves the brightest one under this."""

MOST_STOPS = 2.0
"""Further up, what lamps shine on directly burns."""

MOST_STOPS_IN_SUN = 1.0
"""The same where there is a sun: the sky around it burns first."""

DARKEST_SKIN = 0.055
"""Skin that reflects less than this is metered as if it did: dark skin is to look dark."""

FAR = 100.0
"""Where the sun and the sky are [m]: beyond every house."""

_LOOKS = 12
"""Frames metered, evenly over the take."""

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

_AROUND = {
    "city": (3.36, 1.57, -1.03), "courtyard": (2.36, 1.59, 0.35), "forest": (3.00, 1.14, -1.47),
    "interior": (3.08, 1.02, 0.37), "night": (0.63, -0.09, 0.34), "studio": (3.12, 0.36, -0.21),
    "sunrise": (2.72, 2.39, -1.78), "sunset": (1.73, 0.78, -0.40), "sky": (0.74, 0.30, 0.00),
}  # fmt: skip
"""Irradiance of an upright surface that faces the azimuth φ, over grey ground: a + b cos φ + c sin φ, under
Blender's maps and under its sky (sun at φ = 0), unturned, at strength 1; from renders of a white box."""

_BLOCKED = 0.3
"""What stands before the sky sends this share of the sky's light."""

_ROOM = 0.4
"""Share of light that the surfaces of a room throw back."""

_GROUND = 0.15
"""Irradiance of an upright surface by lit ground before it, over that of the ground."""

Floats = NDArray[np.float64]


def metered(stage: Stage, joints: Sequence[Floats], tones: Sequence[float]) -> Stage:
    """Return a stage exposed for the faces of the people on it, to the hundredth of a stop.

    Args:
        stage: one of the built-in stages; a file's light is its author's.
        joints: of each person (T, 55, 3) [m].
        tones: depth of each person's skin, 0 lightest to 1 darkest.
    """
    skins = [float(linear_image(np.rint(skin_tone(tone)).astype(np.uint8)) @ _LUMINANCE) for tone in tones]
    return replace(stage, exposure=round(stage.exposure + face_stops(stage, joints, skins), 2))


def face_stops(stage: Stage, joints: Sequence[Floats], reflectance: Sequence[float]) -> float:
    """Stops over the stage's exposure, 0 or more, that lift the darkest face to ``FLOOR``.

    Darkest: of the people, in the darker fifth of the frames. Never so far that the brightest burns.

    Args:
        stage: with its light.
        joints: of each person (T, 55, 3) [m].
        reflectance: of each person's skin, linear.
    """
    light = [
        max(skin, DARKEST_SKIN) / np.pi * face_irradiance(stage, person[:: max(1, len(person) // _LOOKS)])
        for person, skin in zip(joints, reflectance, strict=True)
    ]
    gain = 2.0**stage.exposure
    darkest = gain * min(float(np.quantile(one, 0.2)) for one in light)
    brightest = gain * max(float(np.quantile(one, 0.9)) for one in light)
    wanted = np.log2(FLOOR / max(darkest, 1e-6))
    room = np.log2(CEILING / max(brightest, 1e-6))
    in_sun = any(isinstance(one, Sun) for one in stage.lights)
    most = MOST_STOPS_IN_SUN if in_sun else MOST_STOPS
    return float(np.clip(min(wanted, room), 0.0, most))


def face_irradiance(stage: Stage, joints: Floats) -> Floats:
    """Luminous irradiance (T,) of a face, the mean over its front and cheeks; white paper sends ``E / π``.

    Args:
        joints: (T, 55, 3) [m].
    """
    eyes = joints[:, [JOINT_INDEX["left_eye"], JOINT_INDEX["right_eye"]]]
    up = joints[:, JOINT_INDEX["head"]] - joints[:, JOINT_INDEX["neck"]]
    left = unit_vectors(eyes[:, 0] - eyes[:, 1])
    ahead = unit_vectors(np.cross(left, up))
    face = eyes.mean(axis=1) + 0.08 * ahead
    side = np.sin(np.radians(40.0)) * left
    normals = np.stack([ahead, *(np.cos(np.radians(40.0)) * ahead + s * side for s in (-1.0, 1.0))])
    total = _surroundings(stage, face, ahead)
    for light in stage.lights:
        towards, strength = _arriving(light, face)
        seen = ~_shaded(stage.world, face, towards, light)
        direction = unit_vectors(towards)
        cosine = np.clip(np.einsum("nti,ti->nt", normals, direction), 0.0, None).mean(axis=0)
        total += strength * seen * (cosine + _GROUND * np.clip(direction[:, 2], 0.0, None))
    return total + _thrown_back(stage)


def _arriving(light: Sun | Lamp, face: Floats) -> tuple[Floats, Floats]:
    """From each face towards the light (T, 3) [m], and the irradiance (T,) square to it."""
    tint = float(_LUMINANCE @ linear(light.color))
    if isinstance(light, Sun):
        towards = np.broadcast_to(-FAR * unit_vectors(np.asarray(light.direction, float)), face.shape)
        return towards, np.full(len(face), tint * light.strength)
    towards = np.asarray(light.position) - face
    distance = np.linalg.norm(towards, axis=1)
    axis = unit_vectors(np.asarray(light.target, float) - np.asarray(light.position, float))
    along = np.clip(-unit_vectors(towards) @ axis, 0.0, 1.0)
    if light.kind == "area":
        spread = along / np.pi
    else:
        lit = along > np.cos(np.radians(light.spot_angle / 2.0)) if light.kind == "spot" else 1.0
        spread = np.broadcast_to(lit / (4.0 * np.pi), distance.shape)
    return towards, tint * light.power_w * spread / np.maximum(distance, light.size) ** 2


def _shaded(world: World, face: Floats, towards: Floats, light: Sun | Lamp) -> NDArray[np.bool_]:
    """Whether something stands between the faces and the light (T,); what holds a lamp does not."""
    share = 1.0 if isinstance(light, Sun) else 0.97
    return np.asarray(world.hides(face, face + share * towards))


def _surroundings(stage: Stage, face: Floats, ahead: Floats) -> Floats:
    """Irradiance (T,) of upright faces by what surrounds the scene; none gets into a room."""
    environment, world = stage.environment, stage.world
    if world.bounds is not None:
        return np.zeros(len(face))
    azimuth = np.arctan2(ahead[:, 1], ahead[:, 0])
    if environment.kind == "color":
        radiance = float(_LUMINANCE @ linear(environment.color)) * environment.strength
        open_sky = np.full(len(face), 0.5 * np.pi * radiance)
    elif environment.kind == "hdri" and isinstance(environment.hdri, Path):
        open_sky = np.full(len(face), DAY)
    else:
        mean, east, north = _AROUND[str(environment.hdri) if environment.kind == "hdri" else "sky"]
        turned = azimuth - np.radians(environment.rotation)
        open_sky = environment.strength * (mean + east * np.cos(turned) + north * np.sin(turned))
    seen = _sky_seen(world, face, azimuth)
    return np.asarray(open_sky * (seen + _BLOCKED * (1.0 - seen)))


def _sky_seen(world: World, face: Floats, azimuth: Floats) -> Floats:
    """Share (T,) of the light of the sky before upright faces that nothing stands in the way of."""
    aside, above = (grid.ravel() for grid in np.meshgrid(np.radians([-60, -30, 0, 30, 60]),
                                                         np.radians([4, 16, 32, 52])))  # fmt: skip
    weight = np.cos(aside) * np.cos(above) ** 2
    phi = azimuth[:, None] + aside
    level = np.cos(above)
    rays = np.stack([level * np.cos(phi), level * np.sin(phi), np.broadcast_to(np.sin(above), phi.shape)], -1)
    start = np.broadcast_to(face[:, None], rays.shape)
    return np.asarray(~world.hides(start, start + FAR * rays) @ weight / weight.sum())


def _thrown_back(stage: Stage) -> float:
    """Irradiance by what the walls, floor and ceiling of a room send round, the same everywhere in it."""
    if stage.world.bounds is None:
        return 0.0
    width, depth, height = np.subtract(stage.world.bounds[1], stage.world.bounds[0])
    flux = sum(
        light.power_w * float(_LUMINANCE @ linear(light.color))
        for light in stage.lights
        if isinstance(light, Lamp)
    )
    surface = 2.0 * (width * depth + width * height + depth * height)
    return float(flux * _ROOM / (surface * (1.0 - _ROOM)))

"""What a prop is: solids that stand together, each with the finish that it wants."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from render_jobs import Material
from whacamole.stage.shapes import Solid, Vector, box, cylinder, moved
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["Finishes", "Part", "Prop", "PropMaker", "block", "drawn", "drum", "fitted", "paint_finishes"]


@dataclass(frozen=True, eq=False)
class Part:
    """A solid of a prop.

    Attributes:
        solid: about the middle of the prop's underside.
        finish: what it is made of: "wood", "metal", …; a stage has one or several materials for each.
        smooth: shade it as round rather than faceted.
    """

    solid: Solid
    finish: str
    smooth: bool = False


@dataclass(frozen=True, eq=False)
class Prop:
    """A thing that stands about.

    Attributes:
        name: kind of thing.
        size: width, depth and height [m] of the box about the middle of its underside that all of it fills.
            People and cameras keep out of it. Its front looks along −y.
        parts: what it is put together from.
    """

    name: str
    size: Vector
    parts: tuple[Part, ...]


PropMaker = Callable[[np.random.Generator], Prop]
"""Draws a prop of its kind."""

Finishes = dict[str, tuple[Material, ...]]
"""The materials of a stage for each finish; a prop takes one of them for all its parts of that finish."""


def paint_finishes(
    build: SetBuilder, surfaces: Mapping[str, Sequence[tuple[str, float]]], rng: np.random.Generator
) -> Finishes:
    """Paint one material for each (texture, metres after which it repeats) of each finish."""
    return {
        finish: tuple(
            build.material(f"{finish}-{index}", TEXTURES[kind], rng, metres=metres)
            for index, (kind, metres) in enumerate(kinds)
        )
        for finish, kinds in surfaces.items()
    }


def drawn(rng: np.random.Generator, *spans: tuple[float, float]) -> tuple[float, ...]:
    """Draw a number from each range."""
    return tuple(float(rng.uniform(*span)) for span in spans)


def fitted(name: str, parts: Sequence[Part]) -> Prop:
    """Return parts as a prop: moved so that the box around all of them stands about the origin."""
    vertices = np.concatenate([part.solid.vertices for part in parts]).astype(np.float64)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    shift = (*(-(low + high)[:2] / 2.0), -low[2])
    w, d, h = high - low
    placed = tuple(Part(moved(part.solid, shift), part.finish, part.smooth) for part in parts)
    return Prop(name, (float(w), float(d), float(h)), placed)


def block(
    name: str,
    finish: str,
    width: tuple[float, float],
    depth: tuple[float, float],
    height: tuple[float, float],
) -> PropMaker:
    """Return the maker of a plain box with sides from these ranges [m]."""

    def make(rng: np.random.Generator) -> Prop:
        w, d, h = drawn(rng, width, depth, height)
        return Prop(name, (w, d, h), (Part(box((0.0, 0.0, 0.0), (w, d, h)), finish),))

    return make


def drum(name: str, finish: str, radius: tuple[float, float], height: tuple[float, float]) -> PropMaker:
    """Return the maker of a plain upright cylinder of a radius and a height from these ranges [m]."""

    def make(rng: np.random.Generator) -> Prop:
        r, h = drawn(rng, radius, height)
        return Prop(name, (2.0 * r, 2.0 * r, h), (Part(cylinder((0.0, 0.0, 0.0), r, h), finish),))

    return make

"""Ten expression components, each a mix of the 52 face units, scaled so that N(0, 1) looks natural."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from open_people.targets import TargetLibrary

STRENGTH: Final = 0.7

COMPONENTS: Final[dict[str, dict[str, float]]] = {
    "smile, frown": {"mouthSmile*": 0.6, "cheekSquint*": 0.25, "mouthFrown*": -0.6},
    "lips apart, pressed": {
        "mouthUpperUp*": 0.5, "mouthLowerDown*": 0.6, "mouthPress*": -0.35, "mouthRollLower": -0.2
    },
    "brows up, down": {"browInnerUp": 0.5, "browOuterUp*": 0.5, "browDown*": -0.5},
    "eyes wide, closed": {"eyeWide*": 0.12, "eyeBlink*": -0.2},
    "pucker, stretch": {
        "mouthPucker": 0.6, "mouthFunnel": 0.3, "mouthStretch*": -0.45, "mouthDimple*": -0.25
    },
    "sneer": {"noseSneer*": 0.5, "mouthUpperUp*": 0.25},
    "cheek puff": {"cheekPuff": 0.5},
    "inner brow, squint": {"browInnerUp": 0.5, "eyeSquint*": -0.4},
    "mouth left, right": {"mouthLeft": 0.5, "mouthRight": -0.5},
    "one-sided smile": {"mouthSmileLeft": 0.4, "mouthSmileRight": -0.4, "browOuterUpLeft": 0.3,
                        "browOuterUpRight": -0.3},
}  # fmt: skip
"""Weights by face unit; a star stands for both sides."""


def expression_directions(face_units: TargetLibrary) -> NDArray[np.float64]:
    """``(10, N, 3)`` displacements in metres a unit of expression."""
    out = []
    for mix in COMPONENTS.values():
        parts = [
            weight * face_units.dense(unit.replace("*", side))
            for unit, weight in mix.items()
            for side in (("Left", "Right") if "*" in unit else ("",))
        ]
        out.append(STRENGTH * sum(parts))
    return np.stack(out)

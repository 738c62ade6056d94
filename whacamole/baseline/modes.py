"""Where the paper and its released code differ, as named values."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from whacamole.errors import BaselineError

Alignment = Literal["similarity", "scale", "windows"]
Components = Literal["both", "vo", "mv"]
COMPONENTS: tuple[Components, ...] = ("both", "vo", "mv")
"""``both``: WHAC. ``vo``: the odometry's camera in its own unit. ``mv``: the camera derived from the
velocimeter."""


@dataclass(frozen=True)
class Mode:
    """The choices of one way of doing WHAC.

    Attributes:
        name: as typed.
        alignment: of the odometry to the derived camera. ``similarity``: one Umeyama over everything, its
            rotation and scale on the positions. ``scale``: one scale, no rotation. ``windows``: the mean of
            Umeyama's scales over windows of five frames, degenerate ones counting 0, of the longest track
            alone.
        root: what stands for the person in the derived camera: the ``pelvis`` joint, or the parameter
            ``transl``, which is off by the rest pelvis turned with the camera.
        focal: the guess where the focal length is not given
            (:data:`~whacamole.baseline.intrinsics.FOCAL_SOURCES`).
        smoothing: σ of a Gaussian over the camera-frame root [frames], 0 for none.
        overlap: windows of the velocimeter half over each other, so that every frame but the first has a
            past.
    """

    name: str
    alignment: Alignment
    root: Literal["pelvis", "transl"]
    focal: str
    smoothing: float
    overlap: bool


MODES: Mapping[str, Mode] = MappingProxyType(
    {
        mode.name: mode
        for mode in (
            Mode("paper", "similarity", "pelvis", "diagonal", 0.0, True),
            Mode("release", "windows", "transl", "24mm", 2.0, False),
            Mode("steady", "scale", "pelvis", "diagonal", 0.0, True),
        )
    }
)
"""``paper``: the text, with its appendix. ``release``: the code. ``steady``: the paper's, but with the
rotation between two paths that share their orientations left out."""


def mode_named(name: str) -> Mode:
    """A mode by name.

    Raises:
        BaselineError: there is none of this name.
    """
    try:
        return MODES[name]
    except KeyError:
        raise BaselineError(f"no mode {name!r}, only {', '.join(MODES)}") from None


def components_named(name: str) -> Components:
    """Components by name.

    Raises:
        BaselineError: there are none of this name.
    """
    for known in COMPONENTS:
        if known == name:
            return known
    raise BaselineError(f"components {name!r}: expected {', '.join(COMPONENTS)}")

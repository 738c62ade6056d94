"""Protocols: every choice on which evaluators differ, as one named value.

Six are built in. ``dataclasses.replace`` makes others; a result carries the protocol it was made with.
"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from types import MappingProxyType
from typing import Any, Literal, Self, get_args, get_origin

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.segments import Tail

JointSet = Literal["body22", "body15", "smpl24", "h36m14"]
Root = Literal["pelvis", "hips"]
Gaps = Literal["keep", "close"]
RteRoot = Literal["joint", "transl"]
Betas = Literal["given", "mean"]
PaVertices = Literal["vertices", "joints"]
JitterJoints = Literal["all", "emdb"]


ABOUT: Mapping[str, str] = MappingProxyType(
    {
        "segment_frames": "frames of a segment of W-/WA-MPJPE; none: the whole sequence",
        "tail": "the frames left after the last full segment",
        "shortest_tail": "with tail=merge: a shorter tail joins the segment before it",
        "gaps": "frames not scored: keep their place in time, or close up as if they had not been",
        "joints": "joints of all joint metrics",
        "root": "what MPJPE, PVE and Accel subtract: joint 0, or the middle of the hips",
        "fit_frames": "frames at the start of a segment that W-MPJPE is aligned on",
        "with_scale": "W-, WA-MPJPE, H-ATE and C-ATE after a similarity (true) or a rigid motion",
        "accel_trim": "values of Accel dropped at each end of a sequence",
        "fps": "frame rate of Accel and jitter; none: the sequence's own",
        "rte_root": "the root of RTE: joint 0, or the parameter transl",
        "still_speed": "a foot point slower than this is in contact [m/s at the frame rate above]",
        "jitter_joints": "joints of jitter; emdb: nine count as still, the mean is over all",
        "betas": "predicted shape: as given for each frame, or its mean over the track",
        "smooth_root": "σ of the Gaussian over the predicted root path [frames], 0: none",
        "pa_vertices": "PA-PVE aligned by the vertices themselves or by the joints",
    }
)
"""What each choice decides."""


@dataclass(frozen=True)
class Protocol:
    """How a prediction is scored. docs/metrics.md sets the built-in ones side by side."""

    name: str
    segment_frames: int | None
    tail: Tail
    shortest_tail: int
    gaps: Gaps
    joints: JointSet
    root: Root
    fit_frames: int
    with_scale: bool
    accel_trim: int
    fps: float | None
    rte_root: RteRoot
    still_speed: float
    jitter_joints: JitterJoints
    betas: Betas
    smooth_root: float
    pa_vertices: PaVertices
    headline: tuple[str, ...]

    def __post_init__(self) -> None:
        for spec in fields(self):
            value, options = getattr(self, spec.name), get_args(spec.type)
            if get_origin(spec.type) is Literal and value not in options:
                raise EvaluationError(
                    f"protocol: {spec.name}={value!r}, expected one of {', '.join(options)}"
                )
        positive = {
            "segment_frames": self.segment_frames or 1, "fit_frames": self.fit_frames,
            "still_speed": self.still_speed, "fps": self.fps or 1.0,
        }  # fmt: skip
        for name, number in positive.items():
            if number <= 0:
                raise EvaluationError(f"protocol: {name}={number}, expected more than 0")

    def choices(self) -> list[tuple[str, str, str]]:
        """(name, value, meaning) of every choice but the name and the table."""
        return [(name, spell(getattr(self, name)), about) for name, about in ABOUT.items()]

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return asdict(self) | {"headline": list(self.headline)}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Self:
        """Undo :meth:`as_dict`."""
        return cls(**{**values, "headline": tuple(values["headline"])})

    def with_choices(self, given: Mapping[str, str]) -> "Protocol":
        """Change choices by their spelled values, ``{"segment_frames": "200"}``; the name says that it was
        changed.

        Raises:
            EvaluationError: an unknown choice or a value that does not fit.
        """
        return replace(
            self, name=f"{self.name}*", **{key: self._read(key, text) for key, text in given.items()}
        )

    def _read(self, key: str, text: str) -> Any:
        present = {name: getattr(self, name) for name, _, _ in self.choices()}
        if key not in present:
            raise EvaluationError(f"protocol: no choice {key!r}, only {', '.join(present)}")
        if key in ("segment_frames", "fps") and text == "none":
            return None
        kind = {"segment_frames": int, "fps": float}.get(key, type(present[key]))
        try:
            return {"true": True, "false": False}[text] if kind is bool else kind(text)
        except (ValueError, KeyError):
            raise EvaluationError(
                f"protocol: {key}={text!r}, expected a value like {spell(present[key])}"
            ) from None


def spell(value: object) -> str:
    """A choice's value as it is printed and typed."""
    if value is None:
        return "none"
    return (
        str(value).lower()
        if isinstance(value, bool)
        else f"{value:g}"
        if isinstance(value, float)
        else str(value)
    )


_WHAC = Protocol(
    name="whac",
    segment_frames=100,
    tail="merge",
    shortest_tail=10,
    gaps="keep",
    joints="body22",
    root="pelvis",
    fit_frames=2,
    with_scale=True,
    accel_trim=0,
    fps=None,
    rte_root="joint",
    still_speed=0.30,
    jitter_joints="all",
    betas="given",
    smooth_root=0.0,
    pa_vertices="vertices",
    headline=("pa_mpjpe", "w_mpjpe", "wa_mpjpe", "h_ate", "h_as", "c_ate", "c_as"),
)
_WHAM = replace(
    _WHAC,
    name="wham",
    tail="own",
    gaps="close",
    joints="smpl24",
    root="hips",
    accel_trim=1,
    fps=30.0,
    rte_root="transl",
    headline=("pa_mpjpe", "mpjpe", "pve", "accel", "wa_mpjpe", "w_mpjpe", "rte", "jitter", "foot_sliding"),
)
_TRAM = replace(
    _WHAM,
    name="tram",
    tail="tram",
    rte_root="joint",
    betas="mean",
    smooth_root=3.0,
    headline=(
        "pa_mpjpe",
        "mpjpe",
        "pve",
        "accel",
        "wa_mpjpe",
        "w_mpjpe",
        "rte",
        "erve",
        "c_ate",
        "c_ate_rigid",
    ),
)
_GVHMR = replace(_WHAM, name="gvhmr", accel_trim=0, rte_root="joint")
_EMDB = replace(
    _GVHMR,
    name="emdb",
    jitter_joints="emdb",
    pa_vertices="joints",
    headline=("mpjpe", "pa_mpjpe", "mpjae", "pa_mpjae", "pve", "pa_pve", "jitter"),
)
_BEDLAM2 = replace(_GVHMR, name="bedlam2", segment_frames=None, joints="body22")

PROTOCOLS: Mapping[str, Protocol] = MappingProxyType(
    {p.name: p for p in (_WHAC, _WHAM, _TRAM, _GVHMR, _EMDB, _BEDLAM2)}
)
"""The built-in protocols by name."""


def protocol_named(name: str | Protocol) -> Protocol:
    """A built-in protocol by name; a :class:`Protocol` is returned as it is.

    Raises:
        EvaluationError: no such name.
    """
    if isinstance(name, Protocol):
        return name
    try:
        return PROTOCOLS[name]
    except KeyError:
        raise EvaluationError(f"no protocol {name!r}, only {', '.join(PROTOCOLS)}") from None

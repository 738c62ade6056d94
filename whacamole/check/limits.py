"""What a sound dataset keeps to: each number is several times what sound datasets show (docs/check.md)."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """The limits of all checks.

    Attributes:
        rigid: deviation of a camera rotation from orthonormal, and of the two transforms from inverses.
        acceleration: of the camera [m/s²]. spin: of the camera's turning, its rate of change [rad/s²]. joint:
        joints of the parameters against stored joints, and one frame against the other [m]. turn: root
        orientations in the world against those in the camera [rad]. pixel: stored image points against
        projections [px]. box: stored boxes against recomputed ones [px]. ground: the lowest point of all
        people over the sequence against the ground, either way [m]. stray: share of a body's pixels that the
        mask and depth give to nothing in front of it. sunk: share of a person's pixels that show something
        deeper than the body. slack: pixels that may stray or sink in any frame, for the very small. depth:
        how much deeper counts [m]. hands: share of the pixels of hands that may stray, over the sequence.
        flow: median of flow against projected motion, in x and in y [px]. visible: stored visible fraction
        against what masks and bodies allow. contact: gaps against gaps recomputed from the vertices [m].
        bits: share of vertices whose contact differs. unit: length of a normal against 1, or 0 where nothing
        is hit. away: share of pixels whose normal faces away from the camera. askew: share of a person's
        even pixels whose normal is far off the slope of the depth. askew_scenery: the same of everything
        else, which may have relief painted on. order_labels: how much better another frame's picture must
        fit the labels to be taken for the right one. order_rgb: the same for the colour frame.
    """

    rigid: float = 1e-6
    acceleration: float = 60.0
    spin: float = 60.0
    joint: float = 1e-3
    turn: float = 1e-3
    pixel: float = 0.05
    box: float = 0.5
    ground: float = 1.0
    stray: float = 0.01
    sunk: float = 0.02
    slack: int = 6
    depth: float = 0.02
    hands: float = 0.08
    flow: float = 0.5
    visible: float = 0.02
    contact: float = 1e-3
    bits: float = 1e-3
    unit: float = 1e-3
    away: float = 0.01
    askew: float = 0.15
    askew_scenery: float = 0.15
    order_labels: float = 1.05
    order_rgb: float = 1.12

"""Who plays a part: gender, shape and looks, drawn from one seed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render_jobs import Material, Mesh
from whacamole.body import NUM_BETAS, BodyModel, Posed
from whacamole.motion import MotionPerson

__all__ = ["Role", "cast_role"]

SHAPE_SPREAD = 0.8
"""Standard deviation of the drawn betas; 1 is that of the model's own population, with its extremes."""

PAIR_SPREAD = 0.35
"""The same for people captured together: the nearer to the mean, the truer their touches."""

SKIN_TONES = (
    (0.93, 0.78, 0.69), (0.88, 0.70, 0.58), (0.80, 0.61, 0.48), (0.70, 0.51, 0.38),
    (0.58, 0.40, 0.29), (0.46, 0.31, 0.22), (0.36, 0.24, 0.17), (0.28, 0.18, 0.13),
)  # fmt: skip
"""sRGB, from light to dark, drawn evenly."""


@dataclass(frozen=True, eq=False)
class Role:
    """A person's looks.

    Attributes:
        gender: as the motion file says; "neutral" where it does not.
        betas: (10,) in the shape space of the body model in use.
        relaxed_hands: (2, 15, 3) left and right pose for motions that carry none.
        skin: sRGB.
    """

    gender: str
    betas: NDArray[np.float64]
    relaxed_hands: NDArray[np.float64]
    skin: tuple[float, float, float]

    def meshes(self, body: BodyModel, posed: Posed, track_id: int) -> tuple[Mesh, ...]:
        """Return what is drawn of this person, posed for all frames."""
        skin = Material(name=f"skin-{track_id}", base_color=self.skin, roughness=0.55, subsurface=0.1)
        faces = body.quads if body.quads is not None else body.faces
        return (Mesh(f"person-{track_id}", posed.vertices, faces, skin, track_id=track_id),)


def cast_role(rng: np.random.Generator, person: MotionPerson, body: BodyModel, *, interactive: bool) -> Role:
    """Cast one person of a motion.

    With a licensed SMPL-X model the betas of an SMPL-X motion are that person's own and are kept; those of
    any other shape space mean nothing on the model in use, so a shape is drawn.
    """
    spread = PAIR_SPREAD if interactive else SHAPE_SPREAD
    drawn = rng.normal(0.0, spread, NUM_BETAS).clip(-2.0, 2.0)
    skin = SKIN_TONES[int(rng.integers(len(SKIN_TONES)))]
    own = person.betas[:NUM_BETAS]
    licensed = not body.matches(BodyModel.embedded().sha256)
    keeps_own = licensed and person.shape_space == "smplx" and len(own) == NUM_BETAS
    return Role(person.gender, own if keeps_own else drawn, relaxed_hands(body), skin)


def relaxed_hands(body: BodyModel) -> NDArray[np.float64]:
    """Return (2, 15, 3): the model's mean hand poses, or flat hands where it has none."""
    hands = [body.extras.get(key, np.zeros(45)) for key in ("hands_meanl", "hands_meanr")]
    return np.stack([np.asarray(hand, np.float64).reshape(15, 3) for hand in hands])

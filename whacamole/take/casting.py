"""Who plays a part: a dressed person on the embedded body, or a bare one on a model of the user's own."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Material, Mesh
from whacamole.body import NUM_BETAS, BodyModel, BodyParams, Posed
from whacamole.motion import MotionPerson
from whacamole.wardrobe import CastMember, cast, dress, fits

__all__ = ["Role", "cast_role"]

SHAPE_SPREAD = 0.8
"""Standard deviation of betas drawn for a model of the user's own; 1 is that of the model's population."""

PAIR_STATURE = 0.35
"""Factor on the stature and the proportions of people captured together: the nearer to the mean, the truer
their touches."""

STATURE_AXES = [0, 5]
"""The betas of the embedded body that follow stature and proportions (docs/body.md)."""

SKIN_TONES = (
    (0.93, 0.78, 0.69), (0.88, 0.70, 0.58), (0.80, 0.61, 0.48), (0.70, 0.51, 0.38),
    (0.58, 0.40, 0.29), (0.46, 0.31, 0.22), (0.36, 0.24, 0.17), (0.28, 0.18, 0.13),
)  # fmt: skip
"""sRGB, from light to dark, drawn evenly for bare bodies."""


@dataclass(frozen=True, eq=False)
class Role:
    """A person's shape and looks.

    Attributes:
        gender: of the person cast.
        betas: (10,) in the shape space of the body model in use.
        relaxed_hands: (2, 15, 3) left and right pose for motions that carry none.
        member: who it is, with clothes and hair; None for a bare body.
        skin: sRGB of a bare body.
    """

    gender: str
    betas: NDArray[np.float64]
    relaxed_hands: NDArray[np.float64]
    member: CastMember | None
    skin: tuple[float, float, float]

    def meshes(
        self,
        body: BodyModel,
        params: BodyParams,
        posed: Posed,
        *,
        textures: Path,
        track_id: int,
        subdivision: int,
    ) -> tuple[Mesh, ...]:
        """Return what is drawn of this person in all frames of ``params``, the skin first.

        Args:
            posed: the body of ``params``.
            textures: folder for textures made to order.
            track_id: the value in the mask.
            subdivision: levels for skin and clothes.
        """
        name = f"person-{track_id}"
        if self.member is not None:
            return tuple(
                dress(
                    self.member,
                    body,
                    params,
                    textures=textures,
                    track_id=track_id,
                    name=name,
                    subdivision=subdivision,
                )
            )
        material = Material(name=name, base_color=self.skin, roughness=0.55, subsurface=0.1)
        faces = body.quads if body.quads is not None else body.faces
        return (Mesh(name, posed.vertices, faces, material, track_id=track_id, subdivision=subdivision),)


def cast_role(rng: np.random.Generator, person: MotionPerson, body: BodyModel, *, interactive: bool) -> Role:
    """Cast one person of a motion.

    On the embedded body: a member of the wardrobe's cast, of the motion's gender where the file names one.
    On a licensed SMPL-X model: the person's own betas where the motion is in that shape space (those of
    another mean nothing on it), else drawn ones; skin-toned and bare.
    """
    skin = SKIN_TONES[int(rng.integers(len(SKIN_TONES)))]
    if fits(body):
        wish = person.gender if person.gender in ("female", "male") else None
        member = cast(rng, gender=wish)  # type: ignore[arg-type]
        betas = member.betas.copy()
        if interactive:
            betas[STATURE_AXES] *= PAIR_STATURE
        hands = np.stack([member.left_hand, member.right_hand])
        return Role(member.gender, betas, hands, member, skin)
    own = person.betas[:NUM_BETAS]
    keeps_own = person.shape_space == "smplx" and len(own) == NUM_BETAS
    drawn = rng.normal(0.0, SHAPE_SPREAD, NUM_BETAS).clip(-2.0, 2.0)
    return Role(person.gender, own if keeps_own else drawn, _mean_hands(body), None, skin)


def _mean_hands(body: BodyModel) -> NDArray[np.float64]:
    """Return (2, 15, 3): the model's mean hand poses, or flat hands where it has none."""
    hands = [body.extras.get(key, np.zeros(45)) for key in ("hands_meanl", "hands_meanr")]
    return np.stack([np.asarray(hand, np.float64).reshape(15, 3) for hand in hands])

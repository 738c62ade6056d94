"""Who plays a part: a member of the cast, on the embedded body or on a model of the user's own."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Mesh
from whacamole.body import NUM_BETAS, BodyModel, BodyParams
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


@dataclass(frozen=True, eq=False)
class Role:
    """A person's shape and looks.

    Attributes:
        betas: (10,) in the shape space of the body model in use.
        relaxed_hands: (2, 15, 3) left and right pose for motions that carry none.
        member: who it is, with clothes and hair.
    """

    betas: NDArray[np.float64]
    relaxed_hands: NDArray[np.float64]
    member: CastMember

    @property
    def gender(self) -> str:
        """Of the person cast."""
        return self.member.gender

    def meshes(
        self,
        body: BodyModel,
        params: BodyParams,
        *,
        textures: Path,
        uv_textures: Path | None,
        track_id: int,
        subdivision: int,
    ) -> tuple[Mesh, ...]:
        """Return what is drawn of this person in all frames of ``params``, the skin first.

        Args:
            textures: folder for textures made to order.
            uv_textures: the user's folder of pictures for the UV map of the body model; None: our clothes.
            track_id: the value in the mask.
            subdivision: levels for skin and clothes.

        Raises:
            TakeError: ``uv_textures`` has no fitting picture, or the body model no UV map.
        """
        return tuple(
            dress(
                self.member,
                body,
                params,
                textures=textures,
                track_id=track_id,
                name=f"person-{track_id}",
                subdivision=subdivision,
                uv_textures=uv_textures,
            )
        )


def cast_role(rng: np.random.Generator, person: MotionPerson, body: BodyModel, *, interactive: bool) -> Role:
    """Cast one person of a motion: a member of the cast, of the gender that the motion or the body names.

    On a licensed SMPL-X model the member gives skin, hair and clothes; the shape is the person's own where
    the motion is in that shape space (betas of another mean nothing on it), else a drawn one.
    """
    named = [gender for gender in (person.gender, body.gender) if gender in ("female", "male")]
    member = cast(rng, gender=named[0] if named else None)  # type: ignore[arg-type]
    if fits(body):
        betas = member.betas.copy()
        if interactive:
            betas[STATURE_AXES] *= PAIR_STATURE
        return Role(betas, np.stack([member.left_hand, member.right_hand]), member)
    own = person.betas[:NUM_BETAS]
    keeps_own = person.shape_space == "smplx" and len(own) == NUM_BETAS
    drawn = rng.normal(0.0, SHAPE_SPREAD, NUM_BETAS).clip(-2.0, 2.0)
    return Role(own if keeps_own else drawn, _mean_hands(body), member)


def _mean_hands(body: BodyModel) -> NDArray[np.float64]:
    """Return (2, 15, 3): the model's mean hand poses, or flat hands where it has none."""
    hands = [body.extras.get(key, np.zeros(45)) for key in ("hands_meanl", "hands_meanr")]
    return np.stack([np.asarray(hand, np.float64).reshape(15, 3) for hand in hands])

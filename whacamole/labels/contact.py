"""The arrays of ``contact.npz``, built frame by frame. docs/contact.md defines every one of them."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from whacamole.body import BodyModel
from whacamole.labels.arrays import AnyArray, Bools, Floats
from whacamole.labels.ground import ContactThresholds, PartRows, ground_vertices
from whacamole.labels.parts import BodyParts, skinning_parts
from whacamole.labels.patches import PosedSkin, SkinMap
from whacamole.labels.selftouch import SELF_APART, self_touch, separable_parts
from whacamole.labels.skin import OuterSkin
from whacamole.labels.touch import EXACT_WITHIN, touch


class ContactLabels:
    """Collects ``contact.npz``: give it every frame once, in any order, then take :meth:`arrays`.

    Args:
        model: the body model of all people.
        num_people: P.
        num_frames: T.
        fps: frames per second.
        limits: what counts as contact.
        parts: the C parts; by default :func:`whacamole.labels.parts.skinning_parts`.
        self_contact: also label which parts of a person touch others of their own.
    """

    def __init__(
        self,
        model: BodyModel,
        num_people: int,
        num_frames: int,
        fps: float,
        *,
        limits: ContactThresholds | None = None,
        parts: BodyParts | None = None,
        self_contact: bool = False,
    ) -> None:
        self._fps = fps
        self._limits = limits or ContactThresholds()
        self._parts = parts or model_parts(model)
        self._skin = OuterSkin.build(model.v_template, model.faces)
        self._rows = PartRows(self._parts, self._skin.vertices)
        self._on_skin = np.zeros(model.num_vertices, dtype=np.bool_)
        self._on_skin[self._skin.vertices] = True
        shape = (num_people, num_frames, len(self._parts.names))
        self._ground_contact = np.zeros(shape, dtype=np.bool_)
        self._ground_distance = np.full(shape, np.inf, dtype=np.float32)
        pairs = (num_people, num_people, num_frames, len(self._parts.names))
        self._person_contact = np.zeros(pairs, dtype=np.bool_)
        self._person_distance = np.full(pairs, np.inf, dtype=np.float32)
        self._person_part = np.full(pairs, -1, dtype=np.int16)
        wanted = num_people > 1 or self_contact
        self._map = SkinMap.build(self._skin, self._parts, model.v_template) if wanted else None
        self._self_contact: Bools | None = None
        if self_contact and self._map is not None:
            rest = self._skin.close(model.v_template)
            self._separable = separable_parts(self._map, rest, len(self._parts.names))
            self._self_contact = np.zeros((*shape, len(self._parts.names)), dtype=np.bool_)
        self._bits = np.zeros((num_people, num_frames, -(-model.num_vertices // 8)), dtype=np.uint8)

    def add(
        self,
        frame: int,
        before: Sequence[Floats] | None,
        now: Sequence[Floats],
        after: Sequence[Floats] | None,
    ) -> None:
        """Label one frame.

        Args:
            frame: frame index.
            before: ``(V, 3)`` of each person one frame earlier in the world [m], None at the start.
            now: of this frame.
            after: of the next frame, None at the end.
        """
        touching = self._add_persons(frame, now)
        for number, body in enumerate(now):
            grounded = self._on_skin & ground_vertices(
                before[number] if before is not None else None,
                body,
                after[number] if after is not None else None,
                self._fps,
                self._limits,
            )
            self._ground_contact[number, frame] = self._rows.any(grounded)
            self._ground_distance[number, frame] = self._rows.minimum(body[:, 2])
            self._bits[number, frame] = np.packbits(grounded | touching[number])

    def _add_persons(self, frame: int, now: Sequence[Floats]) -> Bools:
        """Label every ordered pair, and return the vertices ``(P, V)`` that touch anybody."""
        touching = np.zeros((len(now), len(self._on_skin)), dtype=np.bool_)
        if self._map is None:
            return touching
        skins = [PosedSkin(self._map, self._skin.close(body)) for body in now]
        if self._self_contact is not None:
            for number, skin in enumerate(skins):
                self._self_contact[number, frame] = self_touch(skin, self._separable, self._limits.person)
        for one, other in combinations(range(len(now)), 2):
            seen = touch(skins[one], skins[other], len(self._parts.names), self._limits.person)
            for pair, side in zip(((one, other), (other, one)), seen, strict=True):
                self._person_distance[*pair, frame] = side.distance
                self._person_contact[*pair, frame] = side.other_part >= 0
                self._person_part[*pair, frame] = side.other_part
                ids = self._map.ids[side.points]
                touching[pair[0], ids[ids < touching.shape[1]]] = True
        return touching

    def arrays(self) -> dict[str, AnyArray]:
        """All keys of ``contact.npz``."""
        own: dict[str, AnyArray] = {}
        if self._self_contact is not None:
            own = {"self_contact": self._self_contact, "self_apart": np.array(SELF_APART)}
        return own | {
            "part_names": np.array(self._parts.names, dtype=np.str_),
            "ground_contact": self._ground_contact,
            "ground_distance": self._ground_distance,
            "person_contact": self._person_contact,
            "person_distance": self._person_distance,
            "person_contact_part": self._person_part,
            "vertex_contact": self._bits,
            "ground_threshold": np.array(self._limits.ground),
            "velocity_threshold": np.array(self._limits.velocity),
            "person_threshold": np.array(self._limits.person),
            "person_exact_within": np.array(EXACT_WITHIN),
        }


def model_parts(model: BodyModel) -> BodyParts:
    """The parts of a body model at its mean shape."""
    return skinning_parts(model.weights, model.v_template, model.rest_joints(np.zeros(10)), model.faces)

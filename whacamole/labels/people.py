"""The arrays of ``people.npz``, built frame by frame."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from camera_rigs import CameraPath
from whacamole.body import BodyModel, BodyParams
from whacamole.labels.arrays import AnyArray, Float64s, Floats, Integers, transformed
from whacamole.labels.cutout import Cutout
from whacamole.labels.mesh import vertex_areas
from whacamole.labels.raster import RasterMesh, outermost, rasterize
from whacamole.labels.visibility import flesh_thickness, joint_visibility, seen_box, truncation, whole_box


class WorldMesh(NamedTuple):
    """Something worn in one frame.

    Attributes:
        vertices: ``(V, 3)`` in the world [m].
        faces: ``(F, 3)`` triangles.
        cutout: what of them is there, where the texture's alpha cuts the surface.
    """

    vertices: Floats
    faces: Integers
    cutout: Cutout | None = None


_EXACT = ("global_orient", "transl")  # float64; all other parameters float32
_PARAMETERS = (
    "expression",
    "global_orient",
    "transl",
    "body_pose",
    "left_hand_pose",
    "right_hand_pose",
    "jaw_pose",
    "leye_pose",
    "reye_pose",
)


@dataclass(frozen=True, eq=False)
class LabelledPerson:
    """One person to label.

    Attributes:
        track_id: >= 1, the value of this person's pixels in the mask.
        motion_id: where the motion comes from.
        gender: as cast.
        params: SMPL-X parameters in the world frame, T frames.
        worn: the clothes and hair of a frame in the world, if any; part of the person's silhouette and box.
    """

    track_id: int
    motion_id: str
    gender: str
    params: BodyParams
    worn: Callable[[int], Sequence[WorldMesh]] | None = None


@dataclass(frozen=True, eq=False)
class FrameImages:
    """What was rendered of one frame.

    Attributes:
        mask: ``(H, W)`` track ids, 0 for background.
        depth: ``(H, W)`` planar z [m], ``inf`` for no hit; None where it was not rendered.
    """

    mask: Integers
    depth: Floats | None = None


def stored_params(params: BodyParams) -> BodyParams:
    """Parameters as the file will hold them, pose and shape rounded to float32: labels follow from labels."""
    names = ("betas", *(name for name in _PARAMETERS if name not in _EXACT))
    return replace(params, **{name: getattr(params, name).astype(np.float32) for name in names})


class PeopleLabels:
    """Collects ``people.npz``: give it every frame once, in any order, then take :meth:`arrays`.

    Args:
        people: P people with T frames each, as :func:`stored_params` made them.
        model: the body model they all use.
        camera: T frames.

    Raises:
        ValueError: frames do not agree, or track ids are not distinct positive numbers.
    """

    def __init__(self, people: Sequence[LabelledPerson], model: BodyModel, camera: CameraPath) -> None:
        _require_consistent(people, camera)
        self._people, self._model, self._camera = people, model, camera
        self._T_camera_world = camera.T_camera_world
        self._arrays = _identity(people, model) | _parameters(people, model, self._T_camera_world)
        shape = (len(people), camera.num_frames)
        self._arrays |= _joints(people, model, camera, self._T_camera_world)
        self._arrays |= {
            "joint_visibility": np.zeros((*shape, len(model.parents)), dtype=np.uint8),
            "bbox_xyxy": np.zeros((*shape, 4), dtype=np.float32),
            "bbox_visible_xyxy": np.zeros((*shape, 4), dtype=np.float32),
            "visible_fraction": np.zeros(shape, dtype=np.float32),
            "truncation": np.zeros(shape, dtype=np.float32),
            "valid": np.zeros(shape, dtype=np.bool_),
        }
        rest = [model.rest_vertices(person.params.betas) for person in people]
        self._thickness = [
            flesh_thickness(vertices, model.rest_joints(person.params.betas))
            for vertices, person in zip(rest, people, strict=True)
        ]
        self._areas = [vertex_areas(vertices.astype(np.float64), model.faces) for vertices in rest]

    def add(self, frame: int, vertices: Sequence[Floats], images: FrameImages) -> None:
        """Label one frame.

        Args:
            frame: frame index.
            vertices: ``(V, 3)`` of each person's body in the world [m].
            images: the rendered mask and depth of this frame.

        Raises:
            ValueError: the images do not have the camera's size.
        """
        size = (self._camera.height, self._camera.width)
        for image in (images.mask, images.depth):
            if image is not None and image.shape != size:
                raise ValueError(
                    f"frame {frame}: image of {image.shape}, the camera has {size} (height, width)"
                )
        for number, body in enumerate(vertices):
            self._add_person(number, frame, body, images)

    def arrays(self) -> dict[str, AnyArray]:
        """All keys of ``people.npz``."""
        return dict(self._arrays)

    def _add_person(self, number: int, frame: int, body: Floats, images: FrameImages) -> None:
        person, out = self._people[number], self._arrays
        K, width, height = self._camera.K[frame], self._camera.width, self._camera.height
        worn = person.worn(frame) if person.worn else ()
        surfaces = [
            RasterMesh(to_camera(mesh.vertices, self._T_camera_world[frame]), mesh.faces, cutout=mesh.cutout)
            for mesh in (WorldMesh(body, self._model.faces), *worn)
        ]
        alone = rasterize(surfaces, K, width, height)
        own = images.mask == person.track_id
        whole = np.count_nonzero(alone.mesh >= 0)
        seen = np.count_nonzero(own)
        at = (number, frame)
        out["valid"][at] = whole > 0 or seen > 0
        out["visible_fraction"][at] = min(seen / whole, 1.0) if whole else float(seen > 0)
        out["truncation"][at] = truncation(surfaces[0].vertices, self._areas[number], K, (width, height))
        out["bbox_xyxy"][at] = whole_box([outermost(mesh) for mesh in surfaces], K)
        out["bbox_visible_xyxy"][at] = seen_box(own)
        out["joint_visibility"][at] = joint_visibility(
            out["joints_camera"][at].astype(np.float64),
            out["joints_image"][at].astype(np.float64),
            self._thickness[number],
            own,
            alone.depth if images.depth is None else images.depth,
        )


def to_camera(points_world: Floats, T_camera_world: Float64s) -> Float64s:
    """World points ``(..., 3)`` in the camera frame of one frame, float64."""
    return transformed(points_world, T_camera_world[:3, :3]) + T_camera_world[:3, 3]


def _require_consistent(people: Sequence[LabelledPerson], camera: CameraPath) -> None:
    ids = [person.track_id for person in people]
    if len(set(ids)) != len(ids) or min(ids, default=1) < 1:
        raise ValueError(f"track ids {ids}: they must be distinct and at least 1")
    for person in people:
        if person.params.num_frames != camera.num_frames:
            raise ValueError(
                f"track {person.track_id} has {person.params.num_frames} frames, "
                f"the camera {camera.num_frames}"
            )


def _identity(people: Sequence[LabelledPerson], model: BodyModel) -> dict[str, AnyArray]:
    return {
        "track_id": np.array([person.track_id for person in people], dtype=np.int64),
        "motion_id": np.array([person.motion_id for person in people], dtype=np.str_),
        "gender": np.array([person.gender for person in people], dtype=np.str_),
        "body_model": np.array(model.name),
        "body_model_sha256": np.array(model.sha256),
        "joint_names": np.array(model.joint_names),
    }


def _parameters(
    people: Sequence[LabelledPerson], model: BodyModel, T_camera_world: Float64s
) -> dict[str, AnyArray]:
    """Parameters in both frames; only the root differs between them."""
    in_camera = [p.params.transformed(T_camera_world, rest_pelvis(model, p.params)) for p in people]
    arrays: dict[str, AnyArray] = {"betas": np.stack([p.params.betas for p in people]).astype(np.float32)}
    for name in _PARAMETERS:
        world = np.stack([getattr(p.params, name) for p in people])
        if name in _EXACT:
            arrays[f"{name}_world"] = world
            arrays[f"{name}_camera"] = np.stack([getattr(params, name) for params in in_camera])
        else:
            arrays[name] = world.astype(np.float32)
    return arrays


def rest_pelvis(model: BodyModel, params: BodyParams) -> Float64s:
    """``(T, 3)`` the pivot of the root rotation, SMPL-X's j0, which betas and expression move."""
    rest = np.broadcast_to(model.rest_joints(params.betas, params.expression), (params.num_frames, 55, 3))
    return np.ascontiguousarray(rest[:, 0])


def _joints(
    people: Sequence[LabelledPerson],
    model: BodyModel,
    camera: CameraPath,
    T_camera_world: Float64s,
) -> dict[str, AnyArray]:
    """Joints in the world, the camera and the image.

    Behind the camera the image coordinates are what the pinhole equation gives, finite but of no meaning.
    """
    world = np.stack([model.pose_joints(person.params) for person in people])
    R, t = T_camera_world[:, :3, :3], T_camera_world[:, :3, 3]
    in_camera = np.einsum("tij,ptnj->ptni", R, world) + t[None, :, None]
    z = in_camera[..., 2:]
    safe = np.where(np.abs(z) < 1e-9, 1e-9, z)
    image = np.einsum("tij,ptnj->ptni", camera.K[:, :2], in_camera / safe)
    return {
        "joints_world": world.astype(np.float32),
        "joints_camera": in_camera.astype(np.float32),
        "joints_image": image.astype(np.float32),
    }

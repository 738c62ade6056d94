"""Labels drawn over pixels: the mesh posed from the stored parameters, joints, boxes and track ids.

Everything here comes from the arrays of ``people.npz`` and ``camera.npz``, never from the rendered scene: if
the drawing fits the picture, the labels do.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from whacamole.body import PARENTS, BodyModel, BodyParams
from whacamole.labels.arrays import AnyArray, Floats, Integers
from whacamole.labels.raster import RasterMesh
from whacamole.labels.shading import shade, track_colour
from whacamole.labels.visibility import OUTSIDE, VISIBLE

Rgb = NDArray[np.uint8]

_SUPERSAMPLE = 2
_BODY_JOINTS = 22


@dataclass(frozen=True)
class OverlayStyle:
    """What to draw.

    Attributes:
        mesh: opacity of the bodies, 0 for none.
        hidden: opacity of bodies where the mask shows something else.
        joints: draw the body's joints and bones: full dots are visible, hollow ones occluded.
        boxes: draw the boxes of what is seen.
        names: write the track ids.
    """

    mesh: float = 0.75
    hidden: float = 0.3
    joints: bool = False
    boxes: bool = False
    names: bool = True


def overlay_frame(
    image: Rgb,
    people: Mapping[str, AnyArray],
    camera: Mapping[str, AnyArray],
    model: BodyModel,
    frame: int,
    *,
    mask: Integers | None = None,
    style: OverlayStyle | None = None,
) -> Rgb:
    """Draw the labels of one frame over its picture.

    Args:
        image: ``(H, W, 3)`` of any size; labels are scaled to it.
        people: arrays of ``people.npz``.
        camera: arrays of ``camera.npz``.
        model: the body model that the labels refer to.
        frame: frame index.
        mask: ``(h, w)`` track ids of the frame: a body is drawn fainter where the mask shows other things.
        style: what to draw.
    """
    style = style or OverlayStyle()
    scale = np.array([image.shape[1] / float(camera["width"]), image.shape[0] / float(camera["height"])])
    drawn = [number for number in range(len(people["track_id"])) if people["valid"][number, frame]]
    picture = image
    if style.mesh > 0 and drawn:
        vertices = [_camera_vertices(people, model, number, frame) for number in drawn]
        ids = [int(people["track_id"][number]) for number in drawn]
        K = np.diag([*scale, 1.0]) @ camera["K"][frame]
        picture = _blend_bodies(image, vertices, model.faces, ids, K, mask, style)
    canvas = Image.fromarray(picture)
    pen = ImageDraw.Draw(canvas)
    for number in drawn:
        _annotate(pen, people, number, frame, scale, style)
    return np.asarray(canvas)


def _camera_vertices(people: Mapping[str, AnyArray], model: BodyModel, number: int, frame: int) -> Floats:
    params = BodyParams.from_arrays(people, "camera", number).slice(frame, frame + 1)
    posed: Floats = model.pose(params).vertices[0]
    return posed


def _blend_bodies(
    image: Rgb,
    vertices: Sequence[Floats],
    faces: Integers,
    ids: Sequence[int],
    K: AnyArray,
    mask: Integers | None,
    style: OverlayStyle,
) -> Rgb:
    """Bodies over the image, smooth at the edges: drawn twice as large and averaged down."""
    height, width = image.shape[:2]
    size = _SUPERSAMPLE
    fine = np.array(K, dtype=np.float64)
    fine[:2] *= size
    meshes = [RasterMesh(body, faces, cull_back=True) for body in vertices]
    shaded = shade(meshes, [track_colour(i) for i in ids], fine, width * size, height * size)
    alpha = np.where(shaded.mesh >= 0, style.mesh, 0.0)
    if mask is not None:
        shown = np.asarray(
            Image.fromarray(mask).resize((width * size, height * size), Image.Resampling.NEAREST)
        )
        own = np.append(np.array(ids), -1)[shaded.mesh]
        alpha = np.where((shaded.mesh >= 0) & (shown != own), style.hidden, alpha)
    blocks = (height, size, width, size)
    weighted = (shaded.colour * alpha[..., None]).reshape(*blocks, 3).mean(axis=(1, 3))
    cover = alpha.reshape(blocks).mean(axis=(1, 3))[..., None]
    blended: Rgb = np.round(image * (1 - cover) + weighted).astype(np.uint8)
    return blended


def _annotate(
    pen: ImageDraw.ImageDraw,
    people: Mapping[str, AnyArray],
    number: int,
    frame: int,
    scale: AnyArray,
    style: OverlayStyle,
) -> None:
    """Joints, box and id of one person."""
    track_id = int(people["track_id"][number])
    colour = track_colour(track_id)
    box = people["bbox_visible_xyxy"][number, frame].reshape(2, 2) * scale
    unit = max(1.0, float(box[1, 1] - box[0, 1]) / 160)
    if style.joints:
        points = people["joints_image"][number, frame, :_BODY_JOINTS] * scale
        _draw_skeleton(pen, points, people["joint_visibility"][number, frame], unit, colour)
    if not box.any():
        return
    if style.boxes:
        pen.rectangle([*box[0], *(box[1] - 1)], outline=colour, width=max(1, round(unit / 2)))
    if style.names:
        font = ImageFont.load_default(size=max(10, 9 * unit))
        anchor = (float(box[0, 0] + box[1, 0]) / 2, max(float(box[0, 1]), 12 * unit))
        pen.text(
            anchor, str(track_id), fill=colour, font=font, anchor="mb", stroke_width=2, stroke_fill=(0, 0, 0)
        )


def _draw_skeleton(
    pen: ImageDraw.ImageDraw,
    points: AnyArray,
    visibility: AnyArray,
    unit: float,
    colour: tuple[int, int, int],
) -> None:
    inside = visibility[:_BODY_JOINTS] != OUTSIDE
    for joint in range(1, _BODY_JOINTS):
        parent = PARENTS[joint]
        if inside[joint] and inside[parent]:
            pen.line([*points[parent], *points[joint]], fill=(255, 255, 255), width=max(1, round(unit)))
    for joint in np.flatnonzero(inside):
        x, y = points[joint]
        dot = [x - 1.5 * unit, y - 1.5 * unit, x + 1.5 * unit, y + 1.5 * unit]
        seen = visibility[joint] == VISIBLE
        pen.ellipse(dot, fill=colour if seen else None, outline=colour, width=max(1, round(unit / 2)))

"""Every difference between Blender versions, and nothing else. Tried with 4.5.15 LTS and 5.0.1."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

IS_5 = bpy.app.version >= (5, 0, 0)

SKY_TYPE = "MULTIPLE_SCATTERING" if IS_5 else "NISHITA"
"""The physical daylight sky."""

OBJECT_INDEX_CHANNEL = "Object Index.X" if IS_5 else "IndexOB.X"
"""The channel of the object index in a multilayer EXR, without the name of the view layer."""

EEVEE = "BLENDER_EEVEE" if IS_5 else "BLENDER_EEVEE_NEXT"
"""The name of the OpenGL engine."""

LINEAR = 1
"""The enum value of linear interpolation of a key frame."""


def animate(target: Any, data_path: str, frames: NDArray[np.int64], values: NDArray[np.float64]) -> None:
    """Key a property at every frame, linear in between.

    Args:
        target: an object or data block of Blender.
        data_path: the property.
        frames: ``(N,)`` frame numbers.
        values: ``(N,)``, or ``(N, k)`` for a property of k components.
    """
    columns = values[:, None] if values.ndim == 1 else values
    for index in range(columns.shape[1]):
        curve = _new_curve(target, data_path, index)
        curve.keyframe_points.add(len(frames))
        points = np.stack([frames.astype(np.float64), columns[:, index]], axis=1)
        curve.keyframe_points.foreach_set("co", points.astype(np.float32).ravel())
        curve.keyframe_points.foreach_set("interpolation", np.full(len(frames), LINEAR, np.int32))
        curve.update()


def _new_curve(target: Any, data_path: str, index: int) -> Any:
    animation = target.animation_data or target.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(target.name)
    action = animation.action
    if IS_5:
        return action.fcurve_ensure_for_datablock(target, data_path, index=index)
    curve = action.fcurves.new(data_path, index=index)
    if animation.action_slot is None:  # 4.5: without a slot the action moves nothing
        animation.action_slot = action.slots[0]
    return curve


def write_bitmap(image_settings: Any) -> None:
    """Make 8-bit BMP the file format."""
    if IS_5:
        image_settings.media_type = "IMAGE"
    image_settings.file_format = "BMP"
    image_settings.color_mode = "RGB"


def write_multilayer_exr(image_settings: Any) -> None:
    """Make float32 uncompressed multilayer EXR the file format: it is read once and removed."""
    if IS_5:
        image_settings.media_type = "MULTI_LAYER_IMAGE"
    image_settings.file_format = "OPEN_EXR_MULTILAYER"
    image_settings.color_depth = "32"
    image_settings.exr_codec = "NONE"

"""Clips are the frames and labels of the sequence, cut in place."""

import numpy as np
import pytest

from whacamole.dataset import Dataset
from whacamole.dataset.clips import Clips, cut


def test_a_clip_is_what_the_sequence_has_there(whole: Dataset) -> None:
    clips = Clips(whole, 2, stride=1, passes=("rgb", "mask", "depth"))
    assert len(clips) == 9
    clip, duet = clips[1], whole["duet-00"]
    assert clip["sequence"] == "duet-00"
    np.testing.assert_array_equal(clip["frame_index"], [1, 2])
    np.testing.assert_array_equal(clip["K"], duet.camera["K"][1:3])
    np.testing.assert_array_equal(clip["rgb"], [duet.rgb(1), duet.rgb(2)])
    np.testing.assert_array_equal(clip["depth"][1], duet.depth(2))
    np.testing.assert_array_equal(clip["joints_world"], duet.people["joints_world"][:, 1:3])
    np.testing.assert_array_equal(clip["betas"], duet.people["betas"])
    assert clip["num_people"] == 2


def test_padding_gives_every_clip_one_shape(whole: Dataset) -> None:
    clips = Clips(whole, 2, passes=(), max_people=3)
    shapes = {
        tuple(value.shape for value in clip.values() if isinstance(value, np.ndarray)) for clip in clips
    }
    assert len(shapes) == 1
    walk = clips[2]
    np.testing.assert_array_equal(walk["track_id"], [1, 0, 0])
    assert not walk["valid"][1:].any()


def test_too_many_people_lose_the_least_seen(whole: Dataset) -> None:
    clip = Clips(whole, 4, passes=(), max_people=1)[0]
    seen = whole["duet-00"].people["visible_fraction"].mean(axis=1)
    assert clip["track_id"].tolist() == [int(np.argmax(seen)) + 1]
    with pytest.raises(ValueError, match="max_people=0"):
        Clips(whole, 4, max_people=0)


@pytest.mark.parametrize("kind", ["camera", "people", "contact"])
def test_every_array_with_a_time_axis_is_cut(whole: Dataset, kind: str) -> None:
    """T = 4 is the length of no other early axis here, so an axis of 4 left over was forgotten."""
    arrays = getattr(whole["duet-00"], kind)
    matrices = {"T_world_camera", "T_camera_world"}
    timed = [key for key, value in arrays.items() if 4 in value.shape[:3] and key not in matrices]
    pieces = cut(kind, arrays, range(1, 2))
    for key in timed:
        axis = arrays[key].shape.index(4)
        np.testing.assert_array_equal(pieces[key], np.take(arrays[key], [1], axis=axis), err_msg=key)
    for key in set(arrays) - set(timed) - matrices:
        np.testing.assert_array_equal(pieces[key], arrays[key])
    if kind == "camera":
        np.testing.assert_array_equal(pieces["T_world_camera"], arrays["T_world_camera"][1:2])

"""What cannot be used is refused in one line that names the file, what is wrong and what to do."""

import contextlib
import io
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests_support import shared_folder
from whacamole.errors import MotionError
from whacamole.motion import container, find_motions, read_motion


def refusal(path: Path) -> str:
    """The message with which ``path`` is refused, checked for its form."""
    with pytest.raises(MotionError) as caught:
        read_motion(path)
    text = str(caught.value)
    assert text.startswith(str(path.parent)), text
    assert "\n" not in text
    assert ";" in text, "what to do comes after a semicolon"
    return text


# One word that says what is wrong with each file of the shared folder.
BAD = {
    "empty_poses": "empty",
    "length_mismatch_poses": "450 poses but 443 translations",
    "nan_poses": "'poses' is not finite",
    "no_rate_poses": "frame rate is missing",
    "no_trans_poses": "'trans' is missing",
    "not_a_zip_poses": "neither npz, npy nor pickle",
    "one_frame_poses": "1 frame",
    "truncated_poses": "damaged npz",
    "wrong_width_poses": r"(450, 100)",
    "zero_rate_poses": "frame rate is 0",
}


def test_every_bad_file_of_the_shared_folder_is_refused():
    folder = shared_folder("motions") / "bad"
    assert {path.stem for path in folder.iterdir()} == set(BAD)
    for name, reason in BAD.items():
        path = folder / f"{name}.npz"
        assert reason in refusal(path)
    assert [file.id for file in find_motions(folder)] == sorted(BAD)


def test_every_good_file_of_the_shared_folder_is_read():
    folder = shared_folder("motions")
    good = [*find_motions(folder / "amass"), *find_motions(folder / "dd100")]
    assert len(good) == 16
    for file in good:
        motion = read_motion(file)
        assert motion.num_frames == file.num_frames
        assert motion.up == ("-y" if file.source == "dd100" else "+z")
        assert len(motion.people) == (2 if file.source == "dd100" else 1)


def amass(**changes: object) -> dict[str, object]:
    """Values of an AMASS SMPL+H file of 90 frames; None leaves one out."""
    values = {
        "poses": np.zeros((90, 156)),
        "trans": np.zeros((90, 3)),
        "betas": np.zeros(16),
        "gender": "male",
        "mocap_framerate": 30.0,
    }
    return {key: value for key, value in (values | changes).items() if value is not None}


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"poses": np.full((90, 156), np.inf)}, "not finite"),
        ({"poses": np.zeros((90, 72))}, r"(90, 72)"),
        ({"poses": np.zeros(90)}, r"(90,)"),
        ({"poses": np.full((90, 156), "x")}, "no plain numbers"),
        ({"poses": np.zeros((90, 156), dtype=complex)}, "no plain numbers"),
        ({"poses": np.full((90, 156), 90.0)}, "radians, not degrees"),
        ({"poses": np.zeros((0, 156)), "trans": np.zeros((0, 3))}, "0 frame"),
        ({"trans": np.zeros((90, 2))}, "expected (frames, 3)"),
        ({"trans": np.full((90, 3), 5000.0)}, "not millimetres"),
        ({"trans": np.zeros((90, 3, 1))[:40]}, "90 poses but 40"),
        ({"mocap_framerate": np.array([30.0, 60.0])}, "one number"),
        ({"mocap_framerate": -120.0}, "frame rate is -120"),
        ({"mocap_framerate": float("nan")}, "not finite"),
        (
            {"mocap_framerate": 1000.0, "poses": np.zeros((9, 156)), "trans": np.zeros((9, 3))},
            "two frames at 30 fps",
        ),
        ({"poses": None, "trans": None, "mocap_framerate": None, "other": 1.0}, "no known motion format"),
    ],
)
def test_wrong_values(tmp_path, changes, reason):
    path = tmp_path / "clip.npz"
    np.savez(path, **amass(**changes))
    assert reason in refusal(path)


@pytest.mark.parametrize(
    ("array", "reason"),
    [
        (np.zeros((90, 322))[:1], "1 frame"),
        (np.zeros((90, 263)), "no known motion format"),
        (np.zeros((90, 22, 3)), "no known motion format"),
        (
            np.array({"smpl_poses": np.zeros((9, 72)), "smpl_trans": np.zeros((9, 3))}, dtype=object),
            "'smpl_scaling'",
        ),
        (
            np.array(
                {"smpl_poses": np.zeros((9, 72)), "smpl_trans": np.zeros((9, 3)), "smpl_scaling": 0.0},
                dtype=object,
            ),
            "'smpl_scaling' is 0",
        ),
        (np.array({"person1": 1, "person2": {}}, dtype=object), "'person1' is no dictionary"),
        (np.array({"person1": {}, "person2": {}}, dtype=object), "(person1): 'root_orient' is missing"),
        (np.array([1, 2], dtype=object), "expected a dictionary"),
        (
            np.array({"poses": [[1.0], [1.0, 2.0]], "transl": np.zeros((2, 3))}, dtype=object),
            "no plain numbers",
        ),
    ],
)
def test_wrong_arrays_and_pickles(tmp_path, array, reason):
    path = tmp_path / "clip.npy"
    np.save(path, array, allow_pickle=True)
    assert reason in refusal(path)


def npy_header(shape: str, descr: str = "<f8") -> bytes:
    """An npy header that claims ``shape``."""
    text = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text.encode()


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (npy_header("(1000000000, 322)"), "at most 1 GB"),
        (npy_header("(500, 322)") + b"0" * 100, "cut off"),
        (npy_header("(-5, 322)"), ""),
        (npy_header("__import__('os')"), "damaged npy header"),
        (npy_header("(2, 322)", "|V8"), ""),
        (b"\x93NUMPY\x03\x00", "damaged npy header"),
        (b"\x93NUMPY", "damaged npy header"),
    ],
)
def test_npy_headers_are_not_believed(tmp_path, content, reason):
    path = tmp_path / "clip.npy"
    path.write_bytes(content)
    assert reason in refusal(path)


def test_a_zip_bomb_is_not_unpacked(tmp_path, monkeypatch):
    monkeypatch.setattr(container, "MAX_BYTES", 10_000_000)
    path = tmp_path / "clip.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("trans.npy", npy_header("(2, 3)") + bytes(48))
        archive.writestr("mocap_framerate.npy", npy_header("()") + struct.pack("<d", 30.0))
        archive.writestr("poses.npy", npy_header("(10000, 156)") + bytes(10000 * 156 * 8))
    assert path.stat().st_size < 20_000
    assert "'poses' claims" in refusal(path)


@pytest.mark.parametrize("member", ["poses.npy", "trans.npy"])
def test_a_damaged_member_is_named(tmp_path, member):
    buffer = io.BytesIO()
    np.savez(buffer, **amass(poses=np.random.default_rng(0).normal(size=(90, 156)), trans=np.ones((90, 3))))
    content = bytearray(buffer.getvalue())
    at = content.index(member.encode()) + 400
    content[at] ^= 0xFF
    path = tmp_path / "clip.npz"
    path.write_bytes(content)
    assert f"'{member.removesuffix('.npy')}' is damaged" in refusal(path)


def test_a_folder_or_nothing_is_no_motion(tmp_path):
    with pytest.raises(MotionError, match="use find_motions"):
        read_motion(tmp_path)
    with pytest.raises(MotionError, match="no such file"):
        read_motion(tmp_path / "missing.npz")
    with pytest.raises(MotionError, match="no motion files"):
        find_motions(tmp_path)


@given(st.data())
@settings(
    max_examples=150,
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_damaged_files_are_read_or_refused(tmp_path, data):
    buffer = io.BytesIO()
    np.savez(buffer, **amass(poses=np.zeros((9, 156)), trans=np.zeros((9, 3))))
    content = bytearray(buffer.getvalue())
    for _ in range(data.draw(st.integers(1, 6))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(content)))
    path = tmp_path / "clip.npz"
    path.write_bytes(content[:cut] if data.draw(st.booleans()) else content)
    with contextlib.suppress(MotionError):
        read_motion(path)

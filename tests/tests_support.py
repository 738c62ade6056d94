"""What the tests of the command line share: running it, motions to run it on, the shared folder."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SMALL = ("--frames", 4, "--quality", "draft", "--size", "96x54", "--shots", "arc,tracking")
"""Options of a render that is as small as one can be and still be a render."""


def shared_folder(name: str) -> Path:
    """Return a folder of real motions beside the checkout, or skip the test where there is none."""
    folder = Path(__file__).resolve().parents[1].parent / "shared" / name
    if not folder.is_dir():
        pytest.skip(f"{name} is not beside this checkout")
    return folder


def run_cli(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run ``whacamole`` and return how it ended."""
    return subprocess.run(
        [sys.executable, "-m", "whacamole", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )


def write_amass(path: Path, frames: int = 40, walk: float = 1.2, seed: int = 0) -> Path:
    """Write an AMASS SMPL-X file: a person who walks along x [m/s], arms down, limbs swinging."""
    rng = np.random.default_rng(seed)
    time = np.arange(frames) / 30.0
    poses = np.zeros((frames, 165))
    poses[:, :3] = [np.pi / 2.0, 0.0, 0.0]  # SMPL-X stands along y; AMASS worlds have z up
    swing = np.sin(2.0 * np.pi * time)[:, None]
    for joint, amplitude in ((1, (0.4, 0, 0)), (2, (-0.4, 0, 0)), (16, (0, 0.3, -1.1)), (17, (0, 0.3, 1.1))):
        poses[:, 3 * joint : 3 * joint + 3] = np.asarray(amplitude) * (swing if joint < 10 else 1.0)
    poses[:, 9:12] += 0.02 * rng.normal(size=3)
    trans = np.stack([walk * time, 0.0 * time, 1.3 + 0.02 * swing[:, 0]], axis=1)
    np.savez(
        path, poses=poses, trans=trans, betas=np.zeros(16), gender=np.array("female"),
        surface_model_type=np.array("smplx"), mocap_frame_rate=np.array(30.0), num_betas=np.array(16),
    )  # fmt: skip
    return path


def write_pair(folder: Path, name: str = "Duet_01_01", frames: int = 30) -> None:
    """Write a DD100 pair, y down: two people face to face, 1 m apart, swaying."""
    time = np.arange(frames) / 30.0
    for index, (x, turn) in enumerate(((-0.5, np.pi / 2.0), (0.5, -np.pi / 2.0))):
        poses = np.zeros((frames, 165))
        c, s = np.cos(turn / 2.0), np.sin(turn / 2.0)
        # Half a turn about x (y down), after a turn about the body's own up axis.
        axis, angle = np.array([c, 0.0, s]), np.pi
        poses[:, :3] = axis * angle
        poses[:, 48:51], poses[:, 51:54] = (0.0, 0.0, -1.1), (0.0, 0.0, 1.1)
        transl = np.stack([x + 0.05 * np.sin(4.0 * time), np.full(frames, -0.95), 0.0 * time], axis=1)
        record = {
            "poses": poses,
            "transl": transl,
            "betas": np.zeros((frames, 10)),
            "meta": {"gender": "neutral"},
        }
        np.save(folder / f"{name}_{index:02d}.npy", np.array(record, dtype=object), allow_pickle=True)

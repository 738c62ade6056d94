"""The baseline's numbers: ablation of its parts, modes and focal lengths, corner cases, speed;
docs/baseline.md.

    python -m benchmarks.baseline parts  WORK     VO alone, MV alone, both; the modes; the focal lengths
    python -m benchmarks.baseline corner WORK     treadmill and skateboard
    python -m benchmarks.baseline pixels WORK DATASET    MediaPipe and OpenCV on a rendered dataset
    python -m benchmarks.baseline speed  WORK     frames a second of the core on one CPU core
    python -m benchmarks.baseline paths  PICTURES DATASET NAME=PREDICTIONS … ID    paths from above, as SVG

Scenes without pixels come from benchmarks.baseline_scenes; all numbers are those of `whacamole evaluate`.
"""

import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.baseline_scenes import write
from whacamole.baseline.charts import Line, chart
from whacamole.baseline.modes import MODES
from whacamole.baseline.odometry import Odometry
from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.recover import recover
from whacamole.baseline.weights import bundled_weights
from whacamole.body import BodyModel, BodyParams
from whacamole.dataset import open_dataset
from whacamole.evaluation.core.alignment import umeyama

ORACLE = ("--estimator", "noisy-labels", "--vo", "noisy-labels", "--masks", "none")
RUNS = {
    "VO alone": ("--components", "vo"),
    "MV alone": ("--components", "mv"),
    "VO + MV, paper": ("--mode", "paper"),
    "VO + MV, release": ("--mode", "release"),
    "VO + MV, steady": ("--mode", "steady"),
    "focal dummy": ("--mode", "steady", "--focal", "dummy"),
    "focal diagonal": ("--mode", "steady", "--focal", "diagonal"),
    "focal 24mm": ("--mode", "steady", "--focal", "24mm"),
    "noise x 0": ("--mode", "steady", "--noise", "0"),
    "noise x 2": ("--mode", "steady", "--noise", "2"),
}


def command(*words: object) -> None:
    """Run a whacamole command and let it print."""
    subprocess.run([sys.executable, "-m", "whacamole", *map(str, words)], check=True)


def compared(data: Path, work: Path, runs: dict[str, Sequence[object]], split: str = "test") -> None:
    """Predict with every set of options and print one table."""
    predictions = []
    for label, options in runs.items():
        out = work / "predictions" / data.name / label.replace(" ", "_")
        command("baseline", "run", "--data", data, "--split", split, "--out", out, *options, "-q")
        predictions += ["--pred", f"{label}={out}"]
    command(
        "evaluate",
        "--data",
        data,
        "--split",
        split,
        *predictions,
        "--vertices",
        "none",
        "--style",
        "markdown",
    )


def parts(work: Path) -> None:
    """Ablation on oracle inputs with noise."""
    data = work / "plain"
    if not data.exists():
        write(data, "plain", 2)
    compared(data, work, {label: (*ORACLE, *options) for label, options in RUNS.items()})


def corner(work: Path) -> None:
    """Motion that says nothing about the way, or the wrong thing."""
    runs = {
        label: (*ORACLE, *RUNS[label])
        for label in ("VO alone", "MV alone", "VO + MV, paper", "VO + MV, release", "VO + MV, steady")
    }
    for kind in ("treadmill", "skateboard"):
        data = work / kind
        if not data.exists():
            write(data, kind, 2)
        compared(data, work, runs)


def pixels(work: Path, data: Path) -> None:
    """From pixels, and what each half costs."""
    runs = {
        "mediapipe, opencv": (),
        "mediapipe, opencv, steady": ("--mode", "steady"),
        "mediapipe, opencv, focal diagonal, steady": ("--mode", "steady", "--focal", "diagonal"),
        "mediapipe, true camera without scale, steady": (
            "--mode", "steady", "--vo", "noisy-labels", "--noise", "0",
        ),
        "true people, opencv, steady": ("--mode", "steady", "--estimator", "noisy-labels", "--noise", "0"),
    }  # fmt: skip
    compared(data, work, runs, "all")


def speed() -> None:
    """Velocimeter, scale and paths, for one person, without reading, estimating and odometry."""
    body, velocimeter, T = BodyModel.embedded(), bundled_weights(), 1920
    rng = np.random.default_rng(0)
    params = BodyParams.zeros(T)
    params.body_pose[:] = 0.1 * rng.normal(size=params.body_pose.shape)
    params.transl[:, 2] = 5.0
    people = [PersonEstimate(1, params, np.ones(T, dtype=bool))]
    poses = np.tile(np.eye(4), (T, 1, 1))
    poses[:, :3, 3] = np.cumsum(rng.normal(size=(T, 3)), axis=0)
    odometry = Odometry.from_poses(poses, np.ones(T, dtype=bool))
    for mode in MODES.values():
        times = []
        for _ in range(5):
            start = time.process_time()
            recover(people, odometry, 30.0, body, velocimeter.windows, mode)
            times.append(time.process_time() - start)
        print(f"{mode.name:8} {T / min(times):8.0f} frames a second of CPU time")


def paths(out: Path, data: Path, predictions: dict[str, Path], sequence_id: str) -> None:
    """Root and camera of one sequence from above, true and predicted, predictions put on the truth
    rigidly."""
    truth = open_dataset(data)[sequence_id]
    cameras = truth.camera["T_world_camera"][:, :3, 3]
    people = truth.people["joints_world"][:, :, 0].astype(np.float64)
    lines = {"camera": [Line("truth", cameras[:, :2])], "person": [Line("truth", people[0, :, :2])]}
    for label, folder in predictions.items():
        with np.load(folder / f"{sequence_id}.npz", allow_pickle=False) as stored:
            pose = stored["T_world_camera"]
            found = BodyParams.from_arrays({k: np.nan_to_num(stored[k]) for k in stored.files}, "world", 0)
            valid = stored["valid"][0]
        pelvis = BodyModel.embedded().pose_joints(found)[:, 0]
        known = np.isfinite(pose).all(axis=(1, 2))
        place = umeyama(
            np.concatenate([pose[known, :3, 3], pelvis[valid]]),
            np.concatenate([cameras[known], people[0, valid]]),
            with_scale=False,
        )
        seen = np.where(valid[:, None], place.apply(pelvis), np.nan)
        lines["camera"].append(Line(label, place.apply(pose[:, :3, 3])[:, :2], dashed=True))
        lines["person"].append(Line(label, seen[:, :2], dashed=True))
    out.mkdir(parents=True, exist_ok=True)
    for what, group in lines.items():
        picture = chart(group, f"{sequence_id}: {what}, from above", "x [m]", "y [m]", equal=True)
        (out / f"{sequence_id}-{what}.svg").write_text(picture)


if __name__ == "__main__":
    task, *words = sys.argv[1:]
    if task == "parts":
        parts(Path(words[0]))
    elif task == "corner":
        corner(Path(words[0]))
    elif task == "pixels":
        pixels(Path(words[0]), Path(words[1]))
    elif task == "speed":
        speed()
    elif task == "paths":
        named = dict(word.split("=", 1) for word in words[2:-1])
        paths(Path(words[0]), Path(words[1]), {k: Path(v) for k, v in named.items()}, words[-1])
    else:
        sys.exit(__doc__)

"""The baseline's numbers: ablation of its parts, modes and focal lengths, corner cases, speed;
docs/baseline.md.

    python -m benchmarks.baseline parts  WORK     VO alone, MV alone, both; the modes; the focal lengths
    python -m benchmarks.baseline corner WORK     treadmill and skateboard
    python -m benchmarks.baseline pixels WORK DATASET    the same from pixels, on a rendered test split
    python -m benchmarks.baseline speed           frames a second of the core on one CPU core
    python -m benchmarks.baseline paths  PICTURES DATASET NAME=PREDICTIONS … ID    paths from above, as SVG

Scenes without pixels come from benchmarks.baseline_scenes; all numbers are those of `whacamole evaluate`.
What is in WORK already is kept: remove it to begin anew.
"""

import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.baseline_scenes import write
from benchmarks.baseline_tables import EACH, INTRINSICS, WORLD, by_sequence, predicted, table
from whacamole.baseline.charts import Line, chart
from whacamole.baseline.modes import MODES
from whacamole.baseline.odometry import Odometry
from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.recover import place_people, recover
from whacamole.baseline.weights import bundled_weights
from whacamole.body import BodyModel, BodyParams
from whacamole.dataset import open_dataset
from whacamole.evaluation.core.alignment import umeyama

ORACLE = ("--estimator", "noisy-labels", "--vo", "noisy-labels", "--masks", "none")
PARTS = {
    "VO alone": ("--components", "vo"),
    "MV alone": ("--components", "mv"),
    "VO + MV, paper": ("--mode", "paper"),
    "VO + MV, release": ("--mode", "release"),
    "VO + MV, steady": ("--mode", "steady"),
}
NOISE = {f"steady, noise x {factor}": ("--mode", "steady", "--noise", factor) for factor in (0, 1, 2)}
FOCALS = {f"focal {source}": ("--focal", source) for source in ("dummy", "diagonal", "24mm", "given")}

STEADY_FOCALS = {label: ("--mode", "steady", *options) for label, options in FOCALS.items()}


def compared(
    data: Path,
    work: Path,
    runs: Mapping[str, Sequence[object]],
    metrics: Sequence[str] = WORLD,
    title: str = "",
) -> None:
    """Predict the test split with every set of options and print one table."""
    folders = predicted(data, work, runs, "test")
    print(f"\n{title or data.name}\n\n{table(data, folders, metrics, 'test')}", flush=True)


def parts(work: Path) -> None:
    """Ablation on oracle inputs with noise."""
    data = work / "plain"
    if not data.exists():
        write(data, "plain", 2)
    oracle(data, work)


def oracle(data: Path, work: Path) -> None:
    """The parts, the noise and the focal lengths, from labels with noise."""
    for title, runs, metrics in (
        ("parts, from labels with noise", PARTS, WORLD),
        ("noise", NOISE, WORLD),
        ("focal lengths, from labels with noise", STEADY_FOCALS, INTRINSICS),
    ):
        every = {f"oracle {label}": (*ORACLE, *options) for label, options in runs.items()}
        compared(data, work, every, metrics, title)


def corner(work: Path) -> None:
    """Motion that says nothing about the way, or the wrong thing."""
    for kind in ("treadmill", "skateboard"):
        data = work / kind
        if not data.exists():
            write(data, kind, 2)
        compared(data, work, {label: (*ORACLE, *options) for label, options in PARTS.items()})


def pixels(work: Path, data: Path) -> None:
    """The parts and the focal lengths from pixels, what each half costs, and the labels on the same
    sequences."""
    compared(data, work, {"from pixels": ()}, title="from pixels")
    # The images are looked at once; what was seen serves all parts.
    seen = work / "predictions" / data.name / "from_pixels"
    print(f"\nby sequence\n\n{by_sequence(data, seen, EACH, 'test')}", flush=True)
    again = ("--estimator", "files", "--estimates", seen, "--vo", "files", "--trajectories", seen)
    compared(
        data,
        work,
        {label: (*again, *options) for label, options in PARTS.items()},
        title="parts, from pixels",
    )
    # With another focal length people are put to the depth that it gives; the odometry stays.
    compared(
        data,
        work,
        {label: (*again, *options) for label, options in FOCALS.items()},
        INTRINSICS,
        "focal lengths, from pixels",
    )
    exact = ("--noise", "0")
    halves = {
        "masks of the labels": (*again[:4], "--masks", "labels"),
        "true camera": (*again[:4], "--vo", "noisy-labels", *exact),
        "true people": ("--estimator", "noisy-labels", *exact, *again[4:]),
    }
    compared(data, work, halves, title="halves")
    oracle(data, work)


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
            found = recover(people, odometry, 30.0, body, velocimeter.windows, mode)
            place_people(people, found, body)
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
    task, *words = sys.argv[1:] or [""]
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

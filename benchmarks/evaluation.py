"""How long an evaluation takes, against the same numbers from a loop over frames.

``python -m benchmarks.evaluation`` makes 100 sequences of 300 frames with two people (a few distinct ones,
linked), scores them without vertices, with a sample of them and with all, and prints seconds and peak memory.
The loop over frames does what the public evaluators do, on a part of one sequence: its time is scaled up and
its numbers are compared with ours.
"""

import argparse
import os
import resource
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel, BodyParams
from whacamole.evaluation import Bodies, evaluate, open_truth, summary
from whacamole.evaluation.core.segments import segments
from whacamole.evaluation.io.predictions import PredictionFolder

DISTINCT = 4
LOOP_FRAMES = 40
NOISE = 0.02
WAYS: dict[str, bool | int] = {
    "joints": False,
    "joints, 1000 vertices": 1000,
    "joints, all vertices": True,
}
Arrays = dict[str, Any]


def main() -> None:
    """Make the data, time every way, print a table in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sequences", type=int, default=100)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--people", type=int, default=2)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        data, predictions = make_data(Path(folder), options.sequences, options.frames, options.people)
        total = options.sequences * options.frames * options.people
        print(f"{options.sequences} sequences × {options.frames} frames × {options.people} people")
        print(f"= {total} bodies a side, {options.jobs} processes\n")
        print("| way | seconds | CPU seconds | memory of a process MB |\n| --- | ---: | ---: | ---: |")
        found: Arrays = {}
        for name, vertices in WAYS.items():
            wall, cpu = time.perf_counter(), cpu_seconds()
            result = evaluate(data, predictions, bodies=Bodies(vertices=vertices), jobs=options.jobs)
            wall, cpu = time.perf_counter() - wall, cpu_seconds() - cpu
            found[name] = summary(result)[predictions.name]
            print(f"| {name} | {wall:.1f} | {cpu:.1f} | {peak_memory():.0f} |", flush=True)
        _, loop, numbers = loop_over_frames(data, predictions, options.people)
        print(f"| loop over frames, all vertices, scaled up | | {loop * total:.0f} | |")
        print(f"\nCPU time of the loop by that of the evaluator, all vertices: {loop * total / cpu:.1f}")
        compare(data, predictions, numbers)
        for key in ("pve", "pa_pve", "t_pve"):
            sample, every = (found[f"joints, {which} vertices"][key] for which in ("1000", "all"))
            print(f"{key}: {every:.3f} mm of all vertices, {sample:.3f} mm of 1000")


def cpu_seconds() -> float:
    """Of this process and of those that it has waited for."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def peak_memory() -> float:
    """Of the largest process so far [MB]."""
    both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return max(resource.getrusage(who).ru_maxrss for who in both) / 1024


def make_data(root: Path, sequences: int, frames: int, people: int) -> tuple[Path, Path]:
    """A dataset and noisy predictions of it; sequences after the first few are links to them."""
    data, predictions = root / "data", root / "noisy"
    predictions.mkdir()
    (data / "splits").mkdir(parents=True)
    ids = [f"made-{number:03d}" for number in range(sequences)]
    (data / "splits" / "test.txt").write_text("\n".join(ids), encoding="utf-8")
    for number, name in enumerate(ids):
        folder = data / "sequences" / name
        folder.mkdir(parents=True)
        if number < DISTINCT:
            camera, labels, guess = make_sequence(np.random.default_rng(number), frames, people)
            np.savez(folder / "camera.npz", **camera)
            np.savez(folder / "people.npz", **labels)
            np.savez(predictions / f"{name}.npz", **guess)
            continue
        source = ids[number % DISTINCT]
        for file in ("camera.npz", "people.npz"):
            os.link(data / "sequences" / source / file, folder / file)
        os.link(predictions / f"{source}.npz", predictions / f"{name}.npz")
    return data, predictions


def make_sequence(rng: np.random.Generator, frames: int, people: int) -> tuple[Arrays, Arrays, Arrays]:
    """The arrays of camera.npz, people.npz and a noisy prediction."""
    model = BodyModel.embedded()
    T_world_camera = np.tile(np.eye(4), (frames, 1, 1))
    T_world_camera[:, :3, :3] = Rotation.from_euler("x", -90, degrees=True).as_matrix()
    T_world_camera[:, :3, 3] = wave(rng, frames, 3) + np.array([0.0, -5.0, 1.2])
    T_camera_world = np.linalg.inv(T_world_camera)
    bodies = [
        BodyParams(
            betas=rng.normal(size=10),
            expression=wave(rng, frames, 10),
            global_orient=np.array([np.pi / 2, 0, 0]) + 0.2 * wave(rng, frames, 3),
            transl=wave(rng, frames, 3) + np.array([1.5 * i, 0, 1.3]),
            body_pose=0.3 * wave(rng, frames, 63).reshape(frames, 21, 3),
            left_hand_pose=0.1 * wave(rng, frames, 45).reshape(frames, 15, 3),
            right_hand_pose=0.1 * wave(rng, frames, 45).reshape(frames, 15, 3),
            **{name: np.zeros((frames, 3)) for name in ("jaw_pose", "leye_pose", "reye_pose")},
        )
        for i in range(people)
    ]
    seen = [body.transformed(T_camera_world, model.rest_joints(body.betas)[0]) for body in bodies]
    labels: Arrays = {key: np.stack([b.to_arrays()[key] for b in bodies]) for key in bodies[0].to_arrays()}
    for key in ("global_orient", "transl"):
        labels[f"{key}_camera"] = np.stack([getattr(body, key) for body in seen])
    labels["track_id"], labels["body_model_sha256"] = np.arange(1, people + 1), np.array(model.sha256)
    film = {
        "frame_index": np.arange(frames),
        "T_world_camera": T_world_camera,
        "K": np.tile(np.diag([500.0, 500.0, 1.0]), (frames, 1, 1)),
    }
    guess = dict(labels)
    for key in ("body_pose", "transl_world", "transl_camera", "global_orient_camera"):
        guess[key] = labels[key] + NOISE * rng.normal(size=labels[key].shape)
    stored = {
        "joints_world": np.stack([model.pose_joints(body) for body in bodies]),
        "joints_camera": np.stack([model.pose_joints(body) for body in seen]),
    }
    return film | {"fps": np.array(30.0)}, labels | stored, guess | film


def wave(rng: np.random.Generator, frames: int, size: int) -> np.ndarray:
    """A smooth random curve (frames, size) of amplitude about 1."""
    turns = np.linspace(0.0, 2.0 * np.pi, frames)[:, None]
    return sum(
        rng.normal(size=size) * np.cos(k * turns + rng.uniform(0, 6, size=size)) / k for k in (1, 2, 3)
    )


def loop_over_frames(data: Path, predictions: Path, people: int) -> tuple[float, float, Arrays]:
    """Seconds and CPU seconds a body, and the first sequence's numbers, one frame after the other."""
    truth = open_truth(data).read("made-000")
    guess = PredictionFolder(predictions).read("made-000", 30.0)
    wall, cpu = time.perf_counter(), time.process_time()
    rows = [
        frame_errors(params_of(truth.people[i], t), params_of(guess.people[i], t))
        for i in range(people)
        for t in range(LOOP_FRAMES)
    ]
    values: Arrays = {key: np.array([row[key] for row in rows]).reshape(people, -1) for key in rows[0]}
    values["w_mpjpe"] = np.stack([world_errors(truth.people[i], guess.people[i]) for i in range(people)])
    bodies = people * LOOP_FRAMES
    return (time.perf_counter() - wall) / bodies, (time.process_time() - cpu) / bodies, values


def params_of(person: Any, t: int, space: str = "camera") -> BodyParams:
    """One frame of a person as parameters."""
    placement = getattr(person, space)
    names = (
        "body_pose",
        "left_hand_pose",
        "right_hand_pose",
        "jaw_pose",
        "leye_pose",
        "reye_pose",
        "expression",
    )
    rest = {name: getattr(person, name)[t : t + 1] for name in names}
    return BodyParams(
        betas=person.betas,
        global_orient=placement.orient[t : t + 1],
        transl=placement.transl[t : t + 1],
        **rest,
    )


def similarity(source: np.ndarray, target: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Scale, rotation and translation of one pair of point sets."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    U, D, Vt = np.linalg.svd(b.T @ a)
    S = np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    R = U @ S @ Vt
    s = np.trace(np.diag(D) @ S) / (a**2).sum()
    return s, R, target.mean(axis=0) - s * R @ source.mean(axis=0)


def frame_errors(truth: BodyParams, guess: BodyParams) -> dict[str, float]:
    """Camera-frame errors of one body in one frame [mm]."""
    model = BodyModel.embedded()
    ours, theirs = model.pose(truth), model.pose(guess)
    errors = {}
    for key, a, b in (
        ("mpjpe", ours.joints[0, :22], theirs.joints[0, :22]),
        ("pve", ours.vertices[0].astype(float), theirs.vertices[0].astype(float)),
    ):
        rooted = (b - theirs.joints[0, 0]) - (a - ours.joints[0, 0])
        s, R, t = similarity(b, a)
        for prefix, apart in (("", rooted), ("pa_", s * b @ R.T + t - a), ("t_", b - a)):
            errors[prefix + key] = 1000 * np.linalg.norm(apart, axis=1).mean()
    return errors


def world_errors(truth: Any, guess: Any) -> list[float]:
    """W-MPJPE of the first frames, which are one segment [mm]."""
    model = BodyModel.embedded()
    both: list[list[np.ndarray]] = [
        [model.pose(params_of(person, t, "world")).joints[0, :22] for t in range(LOOP_FRAMES)]
        for person in (truth, guess)
    ]
    errors: list[float] = []
    for start, stop in segments(LOOP_FRAMES, 100, "own"):
        ours, theirs = both[0][start:stop], both[1][start:stop]
        s, R, t = similarity(np.concatenate(theirs[:2]), np.concatenate(ours[:2]))
        errors += [
            1000 * np.linalg.norm(s * b @ R.T + t - a, axis=1).mean()
            for a, b in zip(ours, theirs, strict=True)
        ]
    return errors


def compare(data: Path, predictions: Path, numbers: Arrays) -> None:
    """Print the largest difference between both ways, frame by frame, on the first sequence."""
    result = evaluate(data, predictions, limit=1)
    score = result.methods[0].sequences["made-000"]
    print()
    for key, values in numbers.items():
        apart = np.abs(score.values[key][:, :LOOP_FRAMES] - values).max()
        print(f"{key}: the two ways differ by at most {apart:.1e} mm in any frame")


if __name__ == "__main__":
    main()

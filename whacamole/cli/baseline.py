"""``whacamole baseline``: WHAC, trained and run."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from whacamole.baseline.footage import Footage
    from whacamole.baseline.run import Outcome, Setup

__all__ = ["app"]

app = typer.Typer(
    help="WHAC, the baseline: train its velocimeter, and recover people and camera in one metric world.",
    no_args_is_help=True,
)


@app.command()
def train(
    out: Annotated[Path, typer.Option(help="Folder for the checkpoint, the loss curve and the weights.")],
    motions: Annotated[
        Path | None, typer.Option(help="Folder of motion files; no pixels needed.", show_default=False)
    ] = None,
    data: Annotated[
        Path | None, typer.Option(help="Dataset: learns from its train split too.", show_default=False)
    ] = None,
    hold_out: Annotated[
        str,
        typer.Option(
            help="Motions to measure on and not to learn from: ids by commas, none, or auto: a fifth."
        ),
    ] = "auto",
    steps: Annotated[int, typer.Option(min=1, help="Batches in all.")] = 1500,
    batch: Annotated[int, typer.Option(min=1, help="Windows in a batch.")] = 64,
    rate: Annotated[float, typer.Option(min=1e-7, max=1.0, help="Learning rate at the start.")] = 2e-3,
    gaits: Annotated[
        int, typer.Option(min=0, help="Made-up walkers in every refresh of the data; 0: motions alone.")
    ] = 120,
    spread: Annotated[
        float, typer.Option(min=0.0, max=2.0, help="How far bodies, strides and paces are varied.")
    ] = 1.0,
    noise: Annotated[float, typer.Option(min=0.0, help="Factor on all noise of the joints.")] = 1.0,
    seed: Annotated[int, typer.Option(help="Of weights, windows and noise.")] = 0,
    body_model: Annotated[
        Path | None,
        typer.Option(help="SMPL-X .npz to perform motions on.", show_default="the embedded CC0 body"),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Train the velocimeter on motion files, on the train split of a dataset, or on both.

    Without either, on the embedded motions. Stopped and started again with the same options, it goes on.
    """
    _one_thread()
    from whacamole.baseline.training_run import TrainingOrder, train_and_save

    recipe = {
        "steps": steps, "batch": batch, "rate": rate, "gaits": gaits, "spread": spread, "seed": seed,
    }  # fmt: skip
    order = TrainingOrder(motions, data, hold_out, recipe, noise, body_model)
    result = train_and_save(order, out, quiet=quiet or json_output)
    result.report(quiet=quiet, as_json=json_output)


@app.command()
def run(
    out: Annotated[Path, typer.Option(help="Folder for one prediction a sequence.")],
    data: Annotated[Path | None, typer.Option(help="Dataset.", show_default=False)] = None,
    split: Annotated[str, typer.Option(help="Split of the dataset, or all.")] = "test",
    video: Annotated[
        Path | None, typer.Option(help="Any video file, in place of a dataset.", show_default=False)
    ] = None,
    estimator: Annotated[
        str, typer.Option(help="People in the camera frame: mediapipe, files or noisy-labels.")
    ] = "mediapipe",
    estimates: Annotated[
        Path | None, typer.Option(help="Folder for --estimator files.", show_default=False)
    ] = None,
    vo: Annotated[str, typer.Option(help="Camera motion: opencv, colmap, files or noisy-labels.")] = "opencv",
    trajectories: Annotated[
        Path | None, typer.Option(help="Folder of TUM files for --vo files.", show_default=False)
    ] = None,
    mode: Annotated[
        str, typer.Option(help="paper, release or steady; docs/baseline.md compares them.")
    ] = "paper",
    components: Annotated[
        str, typer.Option(help="both, or for the ablation vo or mv: odometry or velocimeter alone.")
    ] = "both",
    focal: Annotated[
        str,
        typer.Option(help="given, diagonal, 24mm, dummy or pixels; auto: given if known, else the mode's."),
    ] = "auto",
    masks: Annotated[
        str, typer.Option(help="People hidden from odometry: detector, labels (true masks) or none.")
    ] = "detector",
    noise: Annotated[float, typer.Option(min=0.0, help="Factor on the noise of noisy-labels.")] = 1.0,
    seed: Annotated[int, typer.Option(help="Of that noise.")] = 0,
    weights: Annotated[
        Path | None,
        typer.Option(help="Weights of the velocimeter, .safetensors.", show_default="the bundled ones"),
    ] = None,
    body_model: Annotated[
        Path | None,
        typer.Option(help="SMPL-X .npz to predict with.", show_default="the embedded CC0 body"),
    ] = None,
    keep: Annotated[
        bool, typer.Option("--keep", help="Leave out what has a prediction in --out already.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Recover people and camera in one metric world, from pixels or from what other programs made of them."""
    _one_thread()
    from whacamole.baseline.intrinsics import focal_length
    from whacamole.baseline.modes import components_named, mode_named
    from whacamole.baseline.run import Setup, one_video, run_all, split_footage
    from whacamole.baseline.setup import estimator_named, odometry_named
    from whacamole.baseline.weights import load_weights
    from whacamole.body import BodyModel
    from whacamole.errors import BaselineError

    if (data is None) == (video is None):
        raise BaselineError("name either a dataset by --data or a video by --video")
    if focal not in ("auto", "given"):
        focal_length(focal, 1, 1)  # a mistyped one is told once, not for every sequence
    setup = Setup(
        estimator=estimator_named(estimator, estimates, noise, seed),
        odometry=odometry_named(vo, trajectories, noise, seed),
        mode=mode_named(mode),
        body=BodyModel.embedded() if body_model is None else BodyModel.load(body_model),
        focal=focal,
        masks=masks,
        components=components_named(components),
        weights=None if weights is None else load_weights(weights),
    )
    footage = split_footage(data, split) if data is not None else one_video(video)  # type: ignore[arg-type]
    if keep:
        footage = [one for one in footage if not (out / f"{one.id}.npz").exists()]
    outcomes = []
    with _Bar(len(footage), quiet=quiet or json_output) as bar:
        for outcome in run_all(footage, setup, out, bar.watch):
            outcomes.append(outcome)
            bar.done()
            _tell(outcome, quiet=quiet or json_output)
    _report(outcomes, setup, out, quiet=quiet, as_json=json_output)
    if any(outcome.problem for outcome in outcomes):
        raise typer.Exit(1)


class _Bar:
    """Progress on a terminal: which sequence of how many, what is looked for, and the frames looked at."""

    def __init__(self, sequences: int, *, quiet: bool) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

        console = Console(stderr=True)
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("frames"))
        off = quiet or not console.is_terminal
        # What is printed goes above the bar, but never away from a file that it was sent to.
        self._bar = Progress(
            *columns, console=console, disable=off, transient=True, redirect_stdout=sys.stdout.isatty()
        )
        self._task = self._bar.add_task("", total=None)
        self._sequences, self._count = sequences, 0

    def __enter__(self) -> "_Bar":
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.stop()

    def watch(self, footage: "Footage", stage: str, frames: int) -> None:
        """Where the run is."""
        words = f"{self._count + 1} of {self._sequences}: {footage.id}, {stage}"
        self._bar.update(self._task, description=words, completed=frames, total=footage.num_frames)

    def done(self) -> None:
        """A sequence is finished."""
        self._count += 1


def _one_thread() -> None:
    """Keep BLAS to one thread: the matrices are small, and two threads on a busy machine wait for each
    other."""
    import os

    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")


def _tell(outcome: "Outcome", *, quiet: bool) -> None:
    if outcome.problem:
        typer.echo(f"{outcome.id}: {outcome.problem}", err=True)
    elif not quiet:
        typer.echo(
            f"{outcome.id}: {outcome.people} {'person' if outcome.people == 1 else 'people'}, "
            f"camera in {outcome.camera_frames} of {outcome.frames} frames, scale {outcome.scale:.4g}"
        )
        for note in outcome.notes:
            typer.echo(f"  {note}")


def _report(outcomes: list["Outcome"], setup: "Setup", out: Path, *, quiet: bool, as_json: bool) -> None:
    done = [outcome for outcome in outcomes if not outcome.problem]
    used = sorted({truth for outcome in done for truth in outcome.ground_truth_used.split(",") if truth})
    if as_json:
        import json
        import math
        from dataclasses import asdict

        def plain(value: Any) -> Any:
            return None if isinstance(value, float) and not math.isfinite(value) else value

        sequences = [{key: plain(value) for key, value in asdict(outcome).items()} for outcome in outcomes]
        typer.echo(json.dumps({"out": str(out), "ground_truth_used": used, "sequences": sequences}))
    elif not quiet:
        truth = f"; true data used: {', '.join(used)}" if used else ""
        typer.echo(f"{len(done)} of {len(outcomes)} predictions in {out} ({setup.mode.name}){truth}")

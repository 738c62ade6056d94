"""``whacamole baseline train``: what to learn from, a progress bar, the loss curve, the weights."""

import csv
import io
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from whacamole.baseline.augmentation import Augmentation
from whacamole.baseline.charts import Line, chart
from whacamole.baseline.checkpoint import Checkpoint, read_curve
from whacamole.baseline.clips import Clip, clip_of, dataset_clips, performances
from whacamole.baseline.testing import Errors, measure
from whacamole.baseline.weights import save_weights
from whacamole.body import NUM_BETAS, BodyModel
from whacamole.dataset.files import write_text
from whacamole.dataset.splits import side_of
from whacamole.errors import BaselineError
from whacamole.motion import embedded_motions

TEST_FRACTION = 0.2
"""Share of the motions held out by ``auto``; which side a motion is on depends on its id alone, as in
datasets."""


@dataclass(frozen=True)
class TrainingOrder:
    """What was asked for on the command line.

    Attributes:
        motions, data: where to learn from; neither: the embedded motions.
        hold_out: ids by commas, "none" or "auto".
        recipe: fields of :class:`~whacamole.baseline.training.TrainingRecipe`.
        noise: factor on the noise of the joints.
        body_model: a model file, ``None`` for the embedded body.
    """

    motions: Path | None
    data: Path | None
    hold_out: str
    recipe: dict[str, Any]
    noise: float
    body_model: Path | None


@dataclass(frozen=True)
class TrainingResult:
    """What came out.

    Attributes:
        weights: the file.
        trained, held_out: errors on the motions learnt from and on the others.
        steps: done.
    """

    weights: Path
    trained: Errors | None
    held_out: Errors | None
    steps: int

    def report(self, *, quiet: bool, as_json: bool) -> None:
        """Print it."""
        if as_json:
            errors = {
                side: None if found is None else found.as_dict()
                for side, found in (("trained", self.trained), ("held_out", self.held_out))
            }
            typer.echo(json.dumps({"weights": str(self.weights), "steps": self.steps, **errors}))
        elif not quiet:
            for side, found in (("trained on", self.trained), ("held out", self.held_out)):
                if found is not None:
                    typer.echo(
                        f"{side + ':':12} {found.velocity:.3f} m/s, "
                        f"drift {100.0 * found.drift:.1f} % of the path, "
                        f"pace {found.pace:.3f}, {found.windows} windows"
                    )
            typer.echo(f"weights in {self.weights}")


def train_and_save(order: TrainingOrder, out: Path, *, quiet: bool) -> TrainingResult:
    """Train as ordered; leaves checkpoint, ``loss.csv``, ``loss.svg`` and ``velocimeter.safetensors`` in
    ``out``.

    Raises:
        BaselineError: nothing to learn from, PyTorch is missing, or ``out`` holds another training.
    """
    try:
        from whacamole.baseline.training import TrainingData, TrainingRecipe, train
    except ImportError as error:
        raise BaselineError(f"training needs PyTorch ({error}); pip install 'whacamole[train]'") from error
    body = BodyModel.embedded() if order.body_model is None else BodyModel.load(order.body_model)
    people, clips, held_out = _learnt_from(order, body)
    data = TrainingData(people, clips, held_out)
    if not people and not clips:
        raise BaselineError("nothing to learn from: every motion is held out; see --hold-out")
    recipe = TrainingRecipe(augmentation=_noisier(Augmentation(), order.noise), **order.recipe)
    out.mkdir(parents=True, exist_ok=True)
    with _bar(quiet) as bar:
        task = bar.add_task("training", total=recipe.steps, note="")
        velocimeter = train(
            data,
            recipe,
            body,
            out,
            lambda now: bar.update(task, completed=now.step, note=f"loss {now.loss:.3f}"),
        )
    save_weights(out / "velocimeter.safetensors", velocimeter.weights, velocimeter.about)
    _draw(out, read_curve(out / "checkpoint.safetensors"))
    plain = [clip_of(p.params(body, np.zeros(NUM_BETAS)), body, p.motion) for p in people]
    trained = measure(velocimeter, [*plain, *clips])
    return TrainingResult(
        out / "velocimeter.safetensors", trained, measure(velocimeter, held_out), recipe.steps
    )


def _learnt_from(order: TrainingOrder, body: BodyModel) -> tuple[list[Any], list[Clip], list[Clip]]:
    """People of motion files and clips of datasets to learn from, and clips held out."""
    clips: list[Clip] = []
    held_out: list[Clip] = []
    if order.data is not None:
        clips, held_out = dataset_clips(order.data, "train"), dataset_clips(order.data, "test")
    people = []
    if order.motions is not None or order.data is None:
        people = performances(order.motions or embedded_motions())
    away = _held_out({person.motion for person in people}, order.hold_out)
    # What is held out of the files is kept out of the dataset too, and the other way round.
    away |= {clip.motion for clip in held_out}
    plain = [p for p in people if p.motion in away]
    held_out = held_out + [clip_of(p.params(body, np.zeros(NUM_BETAS)), body, p.motion) for p in plain]
    return [p for p in people if p.motion not in away], [c for c in clips if c.motion not in away], held_out


def _held_out(motions: set[str], spec: str) -> set[str]:
    if spec == "none":
        return set()
    if spec == "auto":
        return {motion for motion in motions if side_of(motion, TEST_FRACTION) == "test"}
    wanted = {part.strip() for part in spec.split(",") if part.strip()}
    unknown = sorted(wanted - motions)
    if unknown:
        raise BaselineError(
            f"--hold-out {unknown[0]}: no such motion; there are {', '.join(sorted(motions))}"
        )
    return wanted


def _noisier(augmentation: Augmentation, factor: float) -> Augmentation:
    names = ("bias", "wander", "jitter", "first_orient", "drift")
    return replace(augmentation, **{name: factor * getattr(augmentation, name) for name in names})


def _bar(quiet: bool) -> Progress:
    console = Console(stderr=True, quiet=quiet)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[note]}"),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=console, disable=quiet or not console.is_terminal)


def _draw(out: Path, state: Checkpoint) -> None:
    """The loss curve, as numbers and as a picture."""
    table = io.StringIO()
    rows = csv.writer(table, lineterminator="\n")
    rows.writerow(["step", "loss", "held_out_velocity_m_s", "held_out_drift", "held_out_pace"])
    for step, loss, errors in state.curve:
        held = ("", "", "") if errors is None else (errors.velocity, errors.drift, errors.pace)
        rows.writerow([step, loss, *held])
    write_text(out / "loss.csv", table.getvalue())
    lines = [Line("loss in training", np.array([[step, loss] for step, loss, _ in state.curve]))]
    measured = [[step, errors.velocity] for step, _, errors in state.curve if errors is not None]
    if measured:
        lines.append(Line("held-out velocity error [m/s]", np.array(measured), dashed=True))
    write_text(out / "loss.svg", chart(lines, "Training of the velocimeter", "step", "m/s"))

"""Training the velocimeter: seeded, resumable, the same weights from the same recipe on the same machine.

Every step draws from a generator keyed by (seed, step), so a run that was stopped goes on as if it had not
been.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import torch

from whacamole.baseline.augmentation import Augmentation, Batch, batch_rand
from whacamole.baseline.checkpoint import Checkpoint, read_checkpoint, write_checkpoint
from whacamole.baseline.clips import Clip, Performance
from whacamole.baseline.gaits import gait_rand
from whacamole.baseline.network import VelocimeterNetwork
from whacamole.baseline.testing import Errors, measure
from whacamole.baseline.variants import perform, variation_rand
from whacamole.baseline.velocimeter import FPS, WINDOW, MotionVelocimeter
from whacamole.body import NUM_BETAS, BodyModel


@dataclass(frozen=True)
class TrainingRecipe:
    """Every choice of a training.

    Attributes:
        steps: batches in all.
        batch: windows in a batch.
        rate: of Adam, falling to nothing along half a cosine.
        seed: of weights, windows and noise.
        takes: how often each person of a motion file is performed anew at every refresh.
        gaits: people of :mod:`~whacamole.baseline.gaits` made at every refresh, of no motion at all.
        refresh: steps between refreshes.
        spread: how far bodies, strides and paces vary (:func:`~whacamole.baseline.variants.variation_rand`).
        stretch: frames of the displacements that the loss looks at beside the velocities.
        augmentation: camera and noise.
    """

    steps: int = 1500
    batch: int = 64
    rate: float = 2e-3
    seed: int = 0
    takes: int = 6
    gaits: int = 120
    refresh: int = 100
    spread: float = 1.0
    stretch: int = 16
    augmentation: Augmentation = field(default_factory=Augmentation)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        return asdict(self)


@dataclass(frozen=True, eq=False)
class TrainingData:
    """What a training sees.

    Attributes:
        performances: people of motion files, varied anew at every refresh.
        clips: people of rendered splits, as they were filmed.
        held_out: what it does not see and is measured on.
    """

    performances: Sequence[Performance]
    clips: Sequence[Clip]
    held_out: Sequence[Clip]

    def motions(self) -> list[str]:
        """Ids of the motions trained on."""
        return sorted({p.motion for p in self.performances} | {clip.motion for clip in self.clips})


@dataclass(frozen=True)
class Progress:
    """Where a training is: steps done, loss now (a running mean), held-out error when it was last
    measured."""

    step: int
    loss: float
    held_out: Errors | None


Watch = Callable[[Progress], None]

MEASURE_EVERY = 250
SAVE_EVERY = 250
_KEEP = 0.98  # of the running mean of the loss


def train(
    data: TrainingData, recipe: TrainingRecipe, body: BodyModel, folder: Path, watch: Watch = lambda _: None
) -> MotionVelocimeter:
    """Train, or go on with the training in ``folder``; leaves ``checkpoint.safetensors`` there.

    Args:
        data: what to learn from.
        recipe: how; a checkpoint of another recipe or other data is refused.
        body: the body that motion files are performed on.
        folder: made if it is not there.
        watch: told after every step.

    Raises:
        BaselineError: the folder holds the checkpoint of another training.
    """
    torch.set_num_threads(1)  # two threads on a busy machine make a GRU of this size a hundred times slower
    torch.use_deterministic_algorithms(True)
    torch.manual_seed(recipe.seed)
    network = VelocimeterNetwork()
    optimizer = torch.optim.Adam(network.parameters(), lr=recipe.rate)
    identity = json.dumps({"recipe": recipe.as_dict(), "motions": data.motions()}, sort_keys=True)
    state = read_checkpoint(folder / "checkpoint.safetensors", network, optimizer, identity)
    pool: list[Clip] = []
    for step in range(state.step, recipe.steps):
        if not pool or step % recipe.refresh == 0:
            pool = _pool_rand(_rng(recipe.seed, step // recipe.refresh, 1), data, recipe, body)
        batch = batch_rand(_rng(recipe.seed, step, 0), pool, recipe.batch, WINDOW, recipe.augmentation)
        for group in optimizer.param_groups:
            group["lr"] = recipe.rate * 0.5 * (1.0 + np.cos(np.pi * step / recipe.steps))
        loss = _train_step(network, optimizer, batch, recipe.stretch)
        state = state.after(loss, _KEEP)
        if state.step % MEASURE_EVERY == 0 or state.step == recipe.steps:
            errors = measure(MotionVelocimeter(network.arrays()), data.held_out)
            state = state.noting(errors)
        if state.step % SAVE_EVERY == 0 or state.step == recipe.steps:
            write_checkpoint(folder / "checkpoint.safetensors", network, optimizer, identity, state)
        watch(Progress(state.step, state.loss, state.last_errors()))
    return _finished(network, data, recipe, state)


def _finished(
    network: VelocimeterNetwork, data: TrainingData, recipe: TrainingRecipe, state: Checkpoint
) -> MotionVelocimeter:
    held_out = state.last_errors()
    about = {
        "recipe": json.dumps(recipe.as_dict()),
        "motions": json.dumps(data.motions()),
        "held_out": json.dumps(sorted({clip.motion for clip in data.held_out})),
        "errors": json.dumps(
            {"loss": state.loss, "held_out": None if held_out is None else held_out.as_dict()}
        ),
        "torch": str(torch.__version__),
    }
    return MotionVelocimeter(network.arrays(), about)


def _train_step(
    network: VelocimeterNetwork, optimizer: torch.optim.Optimizer, batch: Batch, stretch: int
) -> float:
    joints = torch.from_numpy(batch.joints.reshape(*batch.joints.shape[:2], -1).astype(np.float32))
    truth = torch.from_numpy(batch.velocities.astype(np.float32))
    counts = torch.from_numpy(batch.counts.astype(np.float32))
    optimizer.zero_grad()
    loss = velocity_loss(network(joints), truth, counts, stretch)
    loss.backward()
    torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
    optimizer.step()
    return float(loss.detach())


def velocity_loss(
    velocities: torch.Tensor, truth: torch.Tensor, counts: torch.Tensor, stretch: int
) -> torch.Tensor:
    """Mean of the velocities' error [m/s] and of the error of the mean velocity over every ``stretch``
    frames.

    The first makes each frame right; the second the path, whose errors add up and which the scale hangs on.

    Args:
        velocities, truth: (B, L, 3) [m a frame].
        counts: (B, L) 1 for frames that count.
        stretch: frames.
    """
    error = (velocities - truth) * FPS * counts[..., None]
    single = error.norm(dim=-1).sum() / counts.sum()
    summed = torch.nn.functional.avg_pool1d(error.transpose(1, 2), stretch, stride=1) * stretch
    frames = torch.nn.functional.avg_pool1d(counts[:, None], stretch, stride=1)[:, 0] * stretch
    whole = frames > 0.5 * stretch
    mean_error = summed.norm(dim=1) / frames.clamp(min=1.0)
    return single + (mean_error * whole).sum() / whole.sum().clamp(min=1)


def _pool_rand(
    rng: np.random.Generator, data: TrainingData, recipe: TrainingRecipe, body: BodyModel
) -> list[Clip]:
    varied = [
        perform(performance, variation_rand(rng, recipe.spread), body)
        for performance in data.performances
        for _ in range(recipe.takes)
    ]
    shapes = recipe.spread * 0.8 * rng.normal(size=(recipe.gaits, NUM_BETAS))
    steps = [gait_rand(rng, body, betas.clip(-2.0, 2.0)) for betas in shapes]
    return varied + steps + list(data.clips)


def _rng(seed: int, count: int, purpose: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence([seed, count, purpose]))

"""A training on disk: parameters, Adam's moments, the step and the curve, as one safetensors file."""

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from whacamole.baseline.network import VelocimeterNetwork
from whacamole.baseline.testing import Errors
from whacamole.baseline.weights import save_weights
from whacamole.errors import BaselineError

_MOMENTS = ("exp_avg", "exp_avg_sq")


@dataclass(frozen=True)
class Checkpoint:
    """How far a training is.

    Attributes:
        step: steps done.
        loss: running mean.
        curve: (step, loss, held-out errors) at every measurement.
    """

    step: int = 0
    loss: float = float("nan")
    curve: tuple[tuple[int, float, Errors | None], ...] = ()

    def after(self, loss: float, keep: float) -> "Checkpoint":
        """The state one step on."""
        mean = loss if self.step == 0 else keep * self.loss + (1.0 - keep) * loss
        return replace(self, step=self.step + 1, loss=mean)

    def noting(self, errors: Errors | None) -> "Checkpoint":
        """The state with a measurement added to the curve."""
        return replace(self, curve=(*self.curve, (self.step, self.loss, errors)))

    def last_errors(self) -> Errors | None:
        """The held-out errors when they were last measured."""
        return self.curve[-1][2] if self.curve else None


def write_checkpoint(
    path: Path,
    network: VelocimeterNetwork,
    optimizer: torch.optim.Optimizer,
    identity: str,
    state: Checkpoint,
) -> None:
    """Write everything that going on needs; complete or not at all."""
    arrays = {f"network.{name}": value for name, value in network.arrays().items()}
    for name, parameter in network.named_parameters():
        for moment in _MOMENTS:
            arrays[f"{moment}.{name}"] = optimizer.state[parameter][moment].numpy()
    curve = [[step, loss, errors and errors.as_dict()] for step, loss, errors in state.curve]
    about = {
        "identity": identity,
        "state": json.dumps({"step": state.step, "loss": state.loss, "curve": curve}),
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    save_weights(path, arrays, about)


def read_checkpoint(
    path: Path, network: VelocimeterNetwork, optimizer: torch.optim.Optimizer, identity: str
) -> Checkpoint:
    """Put a checkpoint's parameters and moments into place; where there is none, begin.

    Raises:
        BaselineError: it is damaged, or of another recipe or other motions.
    """
    if not path.exists():
        return Checkpoint()
    arrays, about, state = _read(path)
    if about.get("identity") != identity:
        raise BaselineError(f"{path}: of another recipe or other motions; choose another --out or remove it")
    network.load_arrays({name: arrays[f"network.{name}"] for name in network.state_dict()})
    for name, parameter in network.named_parameters():
        optimizer.state[parameter] = {
            "step": torch.tensor(float(state.step)),
            **{moment: torch.from_numpy(np.array(arrays[f"{moment}.{name}"])) for moment in _MOMENTS},
        }
    return state


def read_curve(path: Path) -> Checkpoint:
    """How far a training is, without its parameters.

    Raises:
        BaselineError: it is damaged.
    """
    return _read(path)[2]


def _read(path: Path) -> tuple[dict[str, NDArray[np.float32]], dict[str, str], Checkpoint]:
    from safetensors import SafetensorError, safe_open

    try:
        with safe_open(str(path), framework="numpy") as stored:
            about = stored.metadata() or {}
            arrays = {name: stored.get_tensor(name) for name in stored.keys()}  # noqa: SIM118 - not a mapping
        state = json.loads(about["state"])
        curve = tuple((step, loss, errors and Errors(**errors)) for step, loss, errors in state["curve"])
        return arrays, about, Checkpoint(int(state["step"]), float(state["loss"]), curve)
    except (OSError, SafetensorError, KeyError, TypeError, ValueError) as error:
        raise BaselineError(f"{path}: not a checkpoint ({error}); remove it to begin anew") from error

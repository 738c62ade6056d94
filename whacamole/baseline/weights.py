"""Weights of the velocimeter as safetensors files: read with NumPy alone, and which bundled ones to take.

The header's metadata say how the weights were made: ``recipe`` and ``errors`` (JSON), ``motions``, the ids
that they were trained on (JSON list).
"""

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.velocimeter import MotionVelocimeter
from whacamole.errors import BaselineError

BUNDLED = "velocimeter.safetensors"
"""Trained on all embedded motions; ``velocimeter-<fold>.safetensors`` beside it on all but one fold's."""


def save_weights(path: Path, weights: Mapping[str, NDArray[np.float32]], about: Mapping[str, str]) -> None:
    """Write weights with what is known about them; complete or not at all.

    Raises:
        BaselineError: the file cannot be written.
    """
    from safetensors.numpy import save

    plain = {name: np.ascontiguousarray(value) for name, value in weights.items()}
    beside = path.with_name(f".{path.name}.part")
    try:
        beside.write_bytes(_in_order(save(plain, metadata=dict(about))))
        beside.replace(path)
    except OSError as error:
        raise BaselineError(
            f"{path}: {error.strerror or error}; choose a place that can be written"
        ) from error


def _in_order(stored: bytes) -> bytes:
    """The same file with its header sorted: the library writes metadata in an order that changes from run to
    run."""
    length = int.from_bytes(stored[:8], "little")
    header = json.dumps(json.loads(stored[8 : 8 + length]), sort_keys=True, separators=(",", ":")).encode()
    header += b" " * (-len(header) % 8)
    return len(header).to_bytes(8, "little") + header + stored[8 + length :]


def load_weights(path: Path) -> MotionVelocimeter:
    """Read weights.

    Raises:
        BaselineError: the file is missing, damaged or no velocimeter's.
    """
    try:
        from safetensors import SafetensorError, safe_open
    except ImportError as error:
        raise BaselineError(f"weights need safetensors ({error}); pip install safetensors") from error
    try:
        with safe_open(str(path), framework="numpy") as stored:
            weights = {name: stored.get_tensor(name) for name in stored.keys()}  # noqa: SIM118 - not a mapping
            return MotionVelocimeter(weights, stored.metadata() or {})
    except (OSError, SafetensorError, ValueError) as error:
        raise BaselineError(
            f"{path}: no weights of the velocimeter ({error}); make them with `whacamole baseline train`"
        ) from error


def bundled_weights(motion_id: str | None = None) -> MotionVelocimeter:
    """The weights inside the package.

    For a motion that the embedded ones were made of, the fold's that never saw its capture, so that results
    on datasets of the embedded motions are results on held-out motions. For all else those trained on
    everything.
    """
    everything, folds = _bundled()
    if motion_id in trained_on(everything):
        for fold in folds:
            if motion_id not in trained_on(fold):
                return fold
    return everything


def trained_on(velocimeter: MotionVelocimeter) -> frozenset[str]:
    """Ids of the motions that the weights were trained on, as far as the file says."""
    return frozenset(json.loads(velocimeter.about.get("motions", "[]")))


@cache
def _bundled() -> tuple[MotionVelocimeter, tuple[MotionVelocimeter, ...]]:
    folder = Path(str(resources.files("whacamole") / "assets" / "baseline"))
    folds = sorted(folder.glob("velocimeter-*.safetensors"))
    return load_weights(folder / BUNDLED), tuple(load_weights(path) for path in folds)

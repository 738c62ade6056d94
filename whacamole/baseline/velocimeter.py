"""MotionVelocimeter in NumPy: 15 joints over time → the velocity of the root.

45 → linear 256 → three GRU layers of 64 → linear 64, ReLU, linear 64, ReLU, linear 3: 132,035 parameters, as
in the released code. The paper's text gives no layers. :mod:`whacamole.baseline.network` is the same in
PyTorch.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.method import VELOCIMETER_JOINTS
from whacamole.baseline.rigid import FloatArray

Float32Array = NDArray[np.float32]

INPUTS = 3 * len(VELOCIMETER_JOINTS)
FEATURES = 256
HIDDEN = 64
LAYERS = 3
OUTPUTS = 3

FPS = 30.0
"""Frame rate that the network lives in: a velocity is metres in 1/30 s."""

WINDOW = 64
"""Frames of a training window, and of a window at inference; the state starts at zero in each."""


def parameter_shapes() -> dict[str, tuple[int, ...]]:
    """Name to shape of every parameter, PyTorch's names and layout."""
    shapes: dict[str, tuple[int, ...]] = {"embed.weight": (FEATURES, INPUTS), "embed.bias": (FEATURES,)}
    for layer in range(LAYERS):
        width = FEATURES if layer == 0 else HIDDEN
        shapes[f"gru.weight_ih_l{layer}"] = (3 * HIDDEN, width)
        shapes[f"gru.weight_hh_l{layer}"] = (3 * HIDDEN, HIDDEN)
        shapes[f"gru.bias_ih_l{layer}"] = (3 * HIDDEN,)
        shapes[f"gru.bias_hh_l{layer}"] = (3 * HIDDEN,)
    for index, width in ((0, HIDDEN), (2, HIDDEN), (4, OUTPUTS)):
        shapes[f"head.{index}.weight"] = (width, HIDDEN)
        shapes[f"head.{index}.bias"] = (width,)
    return shapes


@dataclass(frozen=True, eq=False)
class MotionVelocimeter:
    """The network with its weights.

    Attributes:
        weights: every parameter of :func:`parameter_shapes`, float32.
        about: how the weights were made: recipe, data, errors (:mod:`whacamole.baseline.weights`).

    Raises:
        ValueError: a parameter is missing or has a wrong shape.
    """

    weights: Mapping[str, Float32Array]
    about: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, shape in parameter_shapes().items():
            found = self.weights[name].shape if name in self.weights else "nothing"
            if found != shape:
                raise ValueError(f"parameter {name}: {found}, expected {shape}")

    @property
    def num_parameters(self) -> int:
        """132,035."""
        return sum(self.weights[name].size for name in parameter_shapes())

    def __call__(self, canonical: FloatArray) -> FloatArray:
        """Velocities (…, T, 3) [m a frame at 30 fps], each from the frame before, from the joints of a
        window.

        Args:
            canonical: (…, T, 15, 3) [m], as :func:`whacamole.baseline.method.canonicalise` makes them.
        """
        leading, T = canonical.shape[:-3], canonical.shape[-3]
        x = canonical.reshape(-1, T, INPUTS).astype(np.float32)
        x = self._linear("embed", x)
        for layer in range(LAYERS):
            x = self._gru(layer, x)
        for index in (0, 2):
            x = np.maximum(self._linear(f"head.{index}", x), 0.0)
        velocities = self._linear("head.4", x).astype(np.float64)
        return velocities.reshape(*leading, T, OUTPUTS)

    def windows(self, windows: Sequence[FloatArray]) -> list[FloatArray]:
        """Call the network on windows (n, 15, 3) of any lengths, those of one length together."""
        found: list[FloatArray] = [np.empty(0)] * len(windows)
        lengths = np.array([len(window) for window in windows], dtype=np.int64)
        for length in np.unique(lengths):
            members = np.flatnonzero(lengths == length)
            batch = self(np.stack([windows[i] for i in members]))
            for row, i in enumerate(members):
                found[i] = batch[row]
        return found

    def _linear(self, name: str, x: Float32Array) -> Float32Array:
        product: Float32Array = x @ self.weights[f"{name}.weight"].T + self.weights[f"{name}.bias"]
        return product

    def _gru(self, layer: int, x: Float32Array) -> Float32Array:
        """One layer over (B, T, n) → (B, T, 64): gates r, z and candidate n in PyTorch's order and form."""
        W = np.ascontiguousarray(self.weights[f"gru.weight_hh_l{layer}"].T)
        bias = self.weights[f"gru.bias_hh_l{layer}"]
        given = x @ self.weights[f"gru.weight_ih_l{layer}"].T + self.weights[f"gru.bias_ih_l{layer}"]
        out = np.empty((*x.shape[:2], HIDDEN), dtype=np.float32)
        h = np.zeros((len(x), HIDDEN), dtype=np.float32)
        for t in range(x.shape[1]):
            kept = h @ W + bias
            gates = _sigmoid(given[:, t, : 2 * HIDDEN] + kept[:, : 2 * HIDDEN])
            reset, update = gates[:, :HIDDEN], gates[:, HIDDEN:]
            candidate = np.tanh(given[:, t, 2 * HIDDEN :] + reset * kept[:, 2 * HIDDEN :])
            h = (1.0 - update) * candidate + update * h
            out[:, t] = h
        return out


def _sigmoid(x: Float32Array) -> Float32Array:
    """1 / (1 + e⁻ˣ), through tanh so that nothing overflows."""
    half: Float32Array = np.float32(0.5) * (np.float32(1.0) + np.tanh(np.float32(0.5) * x))
    return half

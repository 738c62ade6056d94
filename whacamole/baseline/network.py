"""MotionVelocimeter in PyTorch, for training; parameters named as in
:mod:`whacamole.baseline.velocimeter`."""

from collections.abc import Mapping

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from whacamole.baseline.velocimeter import FEATURES, HIDDEN, INPUTS, LAYERS, OUTPUTS


class VelocimeterNetwork(nn.Module):  # type: ignore[misc]
    """(B, T, 45) → velocities (B, T, 3) [m a frame]."""

    def __init__(self) -> None:
        super().__init__()
        self.embed = nn.Linear(INPUTS, FEATURES)
        self.gru = nn.GRU(FEATURES, HIDDEN, LAYERS, batch_first=True)
        self.head = nn.Sequential(
            nn.Linear(HIDDEN, HIDDEN),
            nn.ReLU(),
            nn.Linear(HIDDEN, HIDDEN),
            nn.ReLU(),
            nn.Linear(HIDDEN, OUTPUTS),
        )

    def forward(self, joints: Tensor) -> Tensor:
        """Run the network over windows of joints, the state starting at zero."""
        return self.head(self.gru(self.embed(joints))[0])

    def arrays(self) -> dict[str, NDArray[np.float32]]:
        """The parameters as NumPy arrays."""
        return {name: value.detach().numpy().copy() for name, value in self.state_dict().items()}

    def load_arrays(self, arrays: Mapping[str, NDArray[np.float32]]) -> None:
        """Take the parameters from NumPy arrays."""
        self.load_state_dict({name: torch.from_numpy(np.array(arrays[name])) for name in self.state_dict()})

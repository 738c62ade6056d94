"""What an estimator is."""

from collections.abc import Sequence
from typing import Protocol

from whacamole.baseline.footage import Footage
from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.rigid import FloatArray
from whacamole.body import BodyModel


class EstimatorSource(Protocol):
    """A way to camera-frame people."""

    @property
    def name(self) -> str:
        """As typed."""
        ...

    @property
    def ground_truth(self) -> tuple[str, ...]:
        """What true data it uses, besides K."""
        ...

    def estimate(self, footage: Footage, K: FloatArray, body: BodyModel) -> Sequence[PersonEstimate]:
        """Everybody found in the footage.

        Args:
            footage: T frames.
            K: (T, 3, 3) [px], given or guessed; decides the depth.
            body: whose parameters are wanted.

        Raises:
            BaselineError: it cannot be done.
        """
        ...

"""People in the camera frame, from any of several sources with one interface.

``mediapipe`` looks at the pixels, ``files`` reads what a published network wrote, ``noisy-labels`` takes the
truth and spoils it.
"""

from whacamole.baseline.estimators.source import EstimatorSource

__all__ = ["EstimatorSource"]

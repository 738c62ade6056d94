"""The evaluator: every number of the field in one place, with every choice named.

::

    from whacamole.evaluation import evaluate, summary

    result = evaluate("dataset", "predictions", protocol="whac")
    print(summary(result))
    result.save("result.npz")

docs/metrics.md defines the metrics and sets the protocols side by side.
"""

from whacamole.errors import EvaluationError
from whacamole.evaluation.catalogue import METRICS, Metric
from whacamole.evaluation.evaluate import Bodies, evaluate, score_recording
from whacamole.evaluation.io.predictions import FORMATS, PredictionFolder
from whacamole.evaluation.pooling import Interval, groups, paired_bootstrap, pooled, summary
from whacamole.evaluation.protocol import PROTOCOLS, Protocol
from whacamole.evaluation.records import CameraTrack, GroundContact, PersonTrack, Placement, Recording
from whacamole.evaluation.result import MethodResult, Result
from whacamole.evaluation.scores import SequenceScore
from whacamole.evaluation.truth.source import TruthSource, open_truth

__all__ = [
    "FORMATS",
    "METRICS",
    "PROTOCOLS",
    "Bodies",
    "CameraTrack",
    "EvaluationError",
    "GroundContact",
    "Interval",
    "MethodResult",
    "Metric",
    "PersonTrack",
    "Placement",
    "PredictionFolder",
    "Protocol",
    "Recording",
    "Result",
    "SequenceScore",
    "TruthSource",
    "evaluate",
    "groups",
    "open_truth",
    "paired_bootstrap",
    "pooled",
    "score_recording",
    "summary",
]

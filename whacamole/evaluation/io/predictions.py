"""A folder of predictions: which file belongs to a sequence, and who wrote it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from whacamole.errors import EvaluationError
from whacamole.evaluation.io.gvhmr import read_gvhmr
from whacamole.evaluation.io.native import read_native
from whacamole.evaluation.io.prompthmr import read_prompthmr
from whacamole.evaluation.io.slahmr import read_slahmr
from whacamole.evaluation.io.tram import read_tram
from whacamole.evaluation.io.tum import read_tum
from whacamole.evaluation.io.wham import read_wham
from whacamole.evaluation.records import Recording

Reader = Callable[[Path, str, float], Recording]


@dataclass(frozen=True)
class Format:
    """One way of writing predictions.

    Attributes:
        name: as typed.
        places: where the file (or what tells the folder) of a sequence is, ``{id}`` for its id.
        folder: whether the reader takes the sequence's folder, not the file found.
        read: from path, sequence id and the truth's frame rate.
    """

    name: str
    places: tuple[str, ...]
    folder: bool
    read: Reader


FORMATS: Mapping[str, Format] = MappingProxyType(
    {
        f.name: f
        for f in (
            Format("native", ("{id}.npz",), False, read_native),
            Format("wham", ("{id}/wham_output.pkl", "{id}.pkl"), False, read_wham),
            Format("gvhmr", ("{id}/hmr4d_results.pt", "{id}.pt"), False, read_gvhmr),
            Format("prompthmr", ("{id}/results.pkl",), False, read_prompthmr),
            Format("tram", ("{id}/camera.npy",), True, read_tram),
            Format(
                "slahmr",
                ("{id}/motion_chunks", "{id}/smooth_fit", "{id}/root_fit", "{id}/*_world_results.npz"),
                True,
                read_slahmr,
            ),
            Format("tum", ("{id}.txt", "{id}.tum", "{id}/traj.txt"), False, read_tum),
        )
    }
)
"""All formats by name, in the order in which they are looked for."""


@dataclass(frozen=True)
class PredictionFolder:
    """Predictions of one method.

    Attributes:
        root: the folder.
        format: a name of :data:`FORMATS`, or "auto": whatever is found for each sequence.
    """

    root: Path
    format: str = "auto"

    def __post_init__(self) -> None:
        if self.format != "auto" and self.format not in FORMATS:
            raise EvaluationError(f"no prediction format {self.format!r}, only auto, {', '.join(FORMATS)}")
        if not self.root.is_dir():
            raise EvaluationError(
                f"{self.root}: not a folder; give the folder that holds one prediction a sequence"
            )

    def read(self, sequence_id: str, fps: float) -> Recording:
        """Read the prediction of a sequence.

        Raises:
            EvaluationError: there is none, or it cannot be used; one line.
        """
        wanted = FORMATS.values() if self.format == "auto" else (FORMATS[self.format],)
        for form in wanted:
            for place in form.places:
                found = self._find(place, sequence_id)
                if found is not None:
                    return form.read(self.root / sequence_id if form.folder else found, sequence_id, fps)
        places = ", ".join(form.places[0].format(id=sequence_id) for form in wanted)
        raise EvaluationError(f"{self.root}: no prediction for {sequence_id} (looked for {places})")

    def _find(self, place: str, sequence_id: str) -> Path | None:
        if "*" in place:
            return next(iter(sorted((self.root / sequence_id).glob(place.split("/", 1)[1]))), None)
        path = self.root / place.format(id=sequence_id)
        return path if path.exists() else None

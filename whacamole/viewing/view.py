"""What `whacamole view` does: a request in, a running viewer or a file out."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from whacamole.dataset import Dataset, Sequence, open_dataset
from whacamole.errors import DatasetError, EvaluationError
from whacamole.viewing.bodies import actors_of, model_for
from whacamole.viewing.live import Viewer, serving
from whacamole.viewing.prediction import Alignment, read_prediction
from whacamole.viewing.progress import passing_bar
from whacamole.viewing.recording import save_html
from whacamole.viewing.scene3d import Look, Scene3D
from whacamole.viewing.thinning import full_surface, thinned_surface

__all__ = ["Request", "save_view", "serve_view"]


@dataclass(frozen=True)
class Request:
    """What to look at.

    Attributes:
        dataset: its folder.
        sequence: an id, None for the first.
        pred: folder of predictions.
        align: where predictions stand.
        body_model: file of the model, None for the embedded one.
    """

    dataset: Path
    sequence: str | None = None
    pred: Path | None = None
    align: Alignment = "camera"
    body_model: Path | None = None

    def opened(self) -> tuple[Dataset, Sequence]:
        """The dataset and the sequence.

        Raises:
            DatasetError: there is none.
        """
        data = open_dataset(self.dataset)
        if not len(data):
            raise DatasetError(f"{self.dataset}: holds no finished sequence; see `whacamole status`")
        return data, data[self.sequence if self.sequence is not None else 0]


def _scene(request: Request, server: Any, sequence: Sequence, look: Look, *, whole: bool) -> Scene3D:
    model = model_for(sequence, request.body_model)
    surface = full_surface(model) if whole else thinned_surface(model)
    prediction = (
        None if request.pred is None else read_prediction(request.pred, sequence, model, request.align)
    )
    return Scene3D(server, sequence, actors_of(sequence, model), surface, prediction, look)


def save_view(request: Request, path: Path, *, full: bool = False, quiet: bool = False) -> int:
    """Write the sequence as one HTML file; return its size in bytes.

    Args:
        full: all vertices of the bodies, not the thinned surface.
        quiet: show no progress.

    Raises:
        DatasetError: there is nothing to show, viser is missing, or the file cannot be written.
        EvaluationError: the prediction cannot be used.
        BodyModelError: the body model cannot be used.
    """
    sequence = request.opened()[1]
    with serving("127.0.0.1", 0) as server, passing_bar(quiet=quiet) as progress:
        look = Look(image_width=320, rounded=True)
        scene = _scene(request, server, sequence, look, whole=full)
        task = progress.add_task(f"saving {sequence.id}", total=len(sequence))
        return save_html(scene, path, lambda _: progress.advance(task))


def serve_view(request: Request, host: str, port: int, say: Callable[[str], object]) -> None:
    """Serve the viewer until it is interrupted.

    Raises:
        DatasetError, EvaluationError, BodyModelError: as :func:`save_view`.
    """
    data, first = request.opened()
    with serving(host, port) as server:

        def draw(sequence_id: str) -> Scene3D:
            sequence = data[sequence_id]
            try:
                return _scene(request, server, sequence, Look(), whole=True)
            except EvaluationError as error:  # the truth can be looked at all the same
                say(str(error))
                return _scene(replace(request, pred=None), server, sequence, Look(), whole=True)

        viewer = Viewer(server, data.ids, draw, first.id)
        say(f"look at http://{host}:{server.get_port()} (Ctrl-C stops)")
        try:
            viewer.run()
        except KeyboardInterrupt:
            say("stopped")

"""What `whacamole page` does: scenes and videos that are wanted and missing, then the page."""

from pathlib import Path

from whacamole.dataset import open_dataset
from whacamole.errors import DatasetError
from whacamole.viewing.page import write_page
from whacamole.viewing.places import Places
from whacamole.viewing.preview import Wanted, make_previews
from whacamole.viewing.view import Request, save_view

__all__ = ["make_page"]


def make_page(
    dataset: Path, *, scenes: int = 0, videos: int = 0, body_model: Path | None = None, quiet: bool = False
) -> Path:
    """Write the page of a dataset; return its path.

    Args:
        scenes: 3D scenes to save first, of sequences that have none.
        videos: videos to make first, of sequences that have none.
        body_model: file of the model, None for the embedded one.
        quiet: show no progress.

    Raises:
        DatasetError: there is no dataset, or a file of it is missing or broken.
        BodyModelError: the body model cannot be used.
    """
    data = open_dataset(dataset)
    places = Places(data.layout.root)
    for sequence_id in [name for name in data.ids if not places.scene(name).exists()][:scenes]:
        request = Request(dataset, sequence_id, body_model=body_model)
        save_view(request, places.scene(sequence_id), quiet=quiet)
    missing = [name for name in data.ids if not places.video(name).exists()][:videos]
    if missing:
        made = make_previews(dataset, missing, Wanted(sheet=False, body_model=body_model), quiet=quiet)
        for name, error in made.failed.items():
            raise DatasetError(f"{name}: {error}")
    write_page(data.layout)
    return places.page

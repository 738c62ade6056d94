"""By which parts of the body the contacts of a sequence are named, so that they can be computed anew."""

from functools import cached_property
from pathlib import Path
from typing import Any

from whacamole.body import BodyModel
from whacamole.check.findings import Report
from whacamole.dataset import Dataset, Sequence
from whacamole.errors import BodyModelError
from whacamole.labels import read_regions
from whacamole.labels.contact import model_parts
from whacamole.labels.parts import BodyParts


class ContactParts:
    """Finds the parts of each sequence: the 21 of the body model, or those of a region file.

    The dataset holds the names of the parts, not which vertices they are. Without a file, the one the recipe
    names is taken if it is still there.

    Args:
        data: the dataset.
        model: the body model of its labels.
        file: the region file, if the user names one.

    Raises:
        BodyModelError: ``file`` is no region file of this body.
    """

    def __init__(self, data: Dataset, model: BodyModel, file: Path | None) -> None:
        self._data, self._model = data, model
        self._file = file
        self._named = None if file is None else read_regions(file, model.num_vertices)
        self._unknown: list[str] = []

    @cached_property
    def _own(self) -> BodyParts:
        return model_parts(self._model)

    @cached_property
    def _of_recipe(self) -> BodyParts | None:
        recipe: Any = self._data.index.get("recipe")
        stated = recipe.get("contact_regions") if isinstance(recipe, dict) else None
        if not isinstance(stated, str) or not Path(stated).is_file():
            return None
        try:
            return read_regions(Path(stated), self._model.num_vertices)
        except BodyModelError:
            return None

    def of(self, sequence: Sequence, report: Report) -> BodyParts | None:
        """The parts of a sequence; None if they are not known."""
        names = tuple(str(name) for name in sequence.contact["part_names"])
        named = self._named
        if named is not None and named.names != names:
            report.add(
                "contact.part_names",
                f"other parts than those of {self._file}",
                _few(names),
                _few(named.names),
            )
        for parts in (named, self._own, self._of_recipe):
            if parts is not None and parts.names == names:
                return parts
        self._unknown.append(sequence.id)
        return None

    def notes(self) -> tuple[str, ...]:
        """What could not be asked of sequences whose parts are not known."""
        if not self._unknown:
            return ()
        more = f" and {len(self._unknown) - 1} more" if len(self._unknown) > 1 else ""
        return (
            f"{self._unknown[0]}{more}: contacts audited for the whole body, not for each part and not of a "
            "person with itself; name the region file of the parts with --contact-regions",
        )


def _few(names: tuple[str, ...]) -> str:
    shown = ", ".join(names[:3])
    return f"{len(names)}: {shown}, …" if len(names) > 3 else shown

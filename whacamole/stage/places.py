"""Where takes may be set: stages by name, stages of the user's own, and the maps that light them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from render_jobs import RenderJobError
from whacamole.errors import RecipeError
from whacamole.stage.light import Hdri, hdri_files, read_hdri
from whacamole.stage.own import OwnStage, check_stage, load_stage, stage_files

__all__ = ["Places", "find_places"]


@dataclass(frozen=True)
class Places:
    """What to choose a place from.

    Attributes:
        names: built-in stages.
        files: stages of the user's own that can be used.
        hdris: environment maps in place of built-in skies.
        cache: folder in which read stages are kept.
        problems: files that cannot be used, a line each.
        notes: what could not be taken over from the others, a line each.
    """

    names: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
    hdris: tuple[Hdri, ...] = ()
    cache: Path = Path()
    problems: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def own(self, file: Path) -> OwnStage:
        """Return one of ``files``, read."""
        return load_stage(file, self.cache)


def find_places(
    stages: tuple[str, ...],
    hdris: Path | None,
    cache: Path,
    builtin: tuple[str, ...],
    on_file: Callable[[Path], None] = lambda _: None,
) -> Places:
    """Read what a recipe names; files that cannot be used are told, and the others go on.

    Args:
        stages: names of built-in stages, files, and folders of files; none means all built-in stages.
        hdris: folder or file of environment maps.
        cache: where read stages are kept.
        builtin: the names there are.
        on_file: told of each stage file before it is read.

    Raises:
        RecipeError: nothing is left to choose from.
    """
    names = tuple(entry for entry in stages if entry in builtin)
    files: list[Path] = []
    problems: list[str] = []
    notes: list[str] = []
    for entry in stages:
        if entry in builtin:
            continue
        try:
            listed = stage_files(Path(entry))
        except RenderJobError as error:
            problems.append(str(error))
            continue
        for file in listed:
            on_file(file)
            try:
                notes += [f"{file}: {note}" for note in check_stage(file, cache)]
                files.append(file)
            except RenderJobError as error:
                problems.append(str(error))
    maps, bad_maps = _read_maps(hdris)
    if stages and not names and not files:
        raise RecipeError(f"stages: none can be used ({'; '.join(problems)})")
    if hdris is not None and not maps:
        raise RecipeError(
            f"hdris: {hdris} holds no usable .exr or .hdr ({'; '.join(bad_maps) or 'none there'})"
        )
    return Places(names, tuple(files), maps, cache, (*problems, *bad_maps), tuple(notes))


@lru_cache(maxsize=4)
def _read_maps(path: Path | None) -> tuple[tuple[Hdri, ...], tuple[str, ...]]:
    found: list[Hdri] = []
    problems: list[str] = []
    for file in hdri_files(path) if path is not None else ():
        try:
            found.append(read_hdri(file))
        except RenderJobError as error:
            problems.append(str(error))
    return tuple(found), tuple(problems)

"""Region files: a segmentation of one body's vertices, such as the 75 regions of SMPL-X, as contact parts.

JSON or ``.npz``, in one of two forms:

* lists of vertices by region: a JSON object of lists, a JSON list of lists, or an ``.npz`` with one array a
  region;
* a region number for each vertex: a JSON list of V integers, or an ``.npz`` with one array of V integers and,
  where wanted, the regions' names in an array ``names``.

Regions without names are called ``region_00``, ``region_01``, … by their numbers.
"""

import json
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import BodyModelError
from whacamole.labels.arrays import AnyArray
from whacamole.labels.parts import BodyParts, parts_from_regions

_NAMES = "names"
_DAMAGED = (zipfile.BadZipFile, zlib.error, NotImplementedError)
_MOST = 32767  # person_contact_part is int16


def read_regions(path: Path, num_vertices: int) -> BodyParts:
    """Parts from a region file. Nothing in the file is executed.

    Args:
        path: ``.json`` or ``.npz``, in a form of the module's description.
        num_vertices: V of the body model the file was made for.

    Raises:
        BodyModelError: the file cannot be read, or does not fit the body.
    """
    try:
        return parts_from_regions(_regions(_contents(path), num_vertices), num_vertices)
    except (ValueError, OSError, EOFError, OverflowError, RecursionError, *_DAMAGED) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise BodyModelError(f"{path}: not a usable region file ({' '.join(reason.split())})") from error


def _contents(path: Path) -> Any:
    suffix = path.suffix.lower()
    if suffix == ".json":
        return json.loads(path.read_text(encoding="utf-8"))
    if suffix != ".npz":
        raise ValueError("its name must end in .json or .npz")
    if path.stat().st_size and not zipfile.is_zipfile(path):
        raise ValueError("no .npz")
    with np.load(path, allow_pickle=False) as stored:
        arrays: dict[str, AnyArray] = dict(stored)
    names = arrays.pop(_NAMES, None)
    if len(arrays) == 1 and names is not None:
        return next(iter(arrays.values())), [str(name) for name in names.ravel()]
    return arrays


def _regions(contents: Any, num_vertices: int) -> dict[str, AnyArray]:
    """Vertex numbers by region, of any form."""
    names: list[str] = []
    if isinstance(contents, tuple):
        contents, names = contents
    if isinstance(contents, dict) and len(contents) == 1:
        # One row of V numbers is a region of the whole body only if it lists every vertex once.
        only = _whole(next(iter(contents.values())), f"region {next(iter(contents))!r}")
        if len(only) == num_vertices and len(np.unique(only)) < num_vertices:
            contents = only
    if isinstance(contents, dict):
        return {str(name): _whole(listed, f"region {name!r}") for name, listed in contents.items()}
    if isinstance(contents, list) and any(isinstance(item, list) for item in contents):
        return {f"region_{k:02d}": _whole(listed, f"region {k}") for k, listed in enumerate(contents)}
    number = _whole(contents, "the list")
    if len(number) != num_vertices:
        raise ValueError(f"it numbers {len(number)} vertices, the body model has {num_vertices}")
    count = max(int(number.max()) + 1, len(names))
    if number.min() < -1 or count > _MOST or (names and count != len(names)):
        of = f"0 to {len(names) - 1}, as there are names" if names else f"0 to {_MOST - 1}"
        raise ValueError(f"region numbers {number.min()} to {number.max()}: must be {of}, or -1 for none")
    if len(set(names)) < len(names):
        raise ValueError("two regions have the same name")
    named = names or [f"region_{k:02d}" for k in range(count)]
    return {name: np.flatnonzero(number == k) for k, name in enumerate(named)}


def _whole(values: Any, what: str) -> AnyArray:
    """One row of whole numbers."""
    row = np.asarray(values)
    if row.ndim != 1 or (row.size and row.dtype.kind not in "iu"):
        raise ValueError(f"{what} is not one row of whole numbers")
    return row.astype(np.int64)

"""Writing files so that a reader never meets half of one."""

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["sha256_of", "write_arrays", "write_json", "write_text"]


def write_text(path: Path, text: str) -> None:
    """Write ``text`` beside ``path`` and rename it into place."""
    beside = path.with_name(f".{path.name}.{os.getpid()}.part")
    beside.write_text(text, encoding="utf-8")
    beside.replace(path)


def write_json(path: Path, value: Any) -> None:
    """Write JSON, keys in the order given, floats in their shortest exact form."""
    write_text(path, json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def write_arrays(path: Path, arrays: Mapping[str, Any]) -> None:
    """Write an ``.npz`` of plain arrays, readable with ``allow_pickle=False``; same arrays, same bytes."""
    beside = path.with_name(f".{path.name}.{os.getpid()}.part")
    plain = {key: np.asarray(value) for key, value in arrays.items()}
    pickled = [key for key, value in plain.items() if value.dtype.hasobject]
    if pickled:
        raise TypeError(f"{path.name}: {', '.join(pickled)} would need pickle")
    with beside.open("wb") as stream:
        np.savez(stream, **plain)
    beside.replace(path)


def sha256_of(path: Path) -> str:
    """Return the hex sha256 of a file."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()

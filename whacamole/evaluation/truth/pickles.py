"""Pickles of the benchmarks: plain dictionaries of arrays, read without executing anything."""

from pathlib import Path
from typing import Any

from whacamole.errors import EvaluationError
from whacamole.motion import safe_pickle


def read_pickle(path: Path) -> dict[str, Any]:
    """The dictionary in a pickle.

    Raises:
        EvaluationError: the file is missing, damaged, or asks for anything but plain data.
    """
    try:
        value = safe_pickle.loads(path.read_bytes())
    except OSError as error:
        raise EvaluationError(f"{path}: {error.strerror or error}") from error
    except safe_pickle.UnsafePickleError as error:
        raise EvaluationError(f"{path}: not read, {error}; fetch the benchmark's file again") from error
    if not isinstance(value, dict):
        raise EvaluationError(f"{path}: holds no dictionary; fetch the benchmark's file again")
    return value

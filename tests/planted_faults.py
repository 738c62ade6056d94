"""What the tests of the audit share: read, spoil and audit a small dataset."""

from pathlib import Path

import numpy as np

from whacamole.check import Findings, check_dataset
from whacamole.dataset.files import write_arrays


def audit(dataset: Path) -> Findings:
    """Audit without checksums: by what labels and pixels say."""
    return check_dataset(dataset, checksums=False)


def labels(findings: Findings) -> set[str]:
    """Which labels were found wrong."""
    return {finding.label for finding in findings}


def load(path: Path) -> dict[str, np.ndarray]:
    """All arrays of a file."""
    with np.load(path, allow_pickle=False) as stored:
        return dict(stored)


def change(path: Path, **arrays: np.ndarray) -> None:
    """Replace arrays of a file."""
    write_arrays(path, load(path) | arrays)

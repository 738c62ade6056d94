"""One dataset for all tests of the exporters; nobody writes into it."""

from pathlib import Path

import pytest

import tiny_dataset
import whacamole
from whacamole.body import BodyModel
from whacamole.dataset import Dataset


@pytest.fixture(scope="session")
def data(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    root = tmp_path_factory.mktemp("exported") / "dataset"
    tiny_dataset.write_dataset(root)
    return whacamole.open(root)


@pytest.fixture(scope="session")
def body_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The embedded body as a file that the smplx package loads."""
    return BodyModel.embedded().export_full(tmp_path_factory.mktemp("body") / "SMPLX_NEUTRAL.npz")

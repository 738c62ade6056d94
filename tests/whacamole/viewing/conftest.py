from pathlib import Path

import pytest

import tiny_dataset
import whacamole
from whacamole.dataset import Dataset


@pytest.fixture(scope="session")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    """Three sequences of four frames."""
    root: Path = tmp_path_factory.mktemp("viewing") / "dataset"
    tiny_dataset.write_dataset(root)
    return whacamole.open(root)

"""A whole small dataset for the tests that only read."""

import pytest

import tiny_dataset
import whacamole
from whacamole.dataset import Dataset


@pytest.fixture(scope="session")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    root = tmp_path_factory.mktemp("whole") / "dataset"
    tiny_dataset.write_dataset(root)
    return whacamole.open(root)

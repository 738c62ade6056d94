import pytest

from baseline_scenes import TrueScene, true_scene
from whacamole.body import BodyModel


@pytest.fixture(scope="session")
def body() -> BodyModel:
    return BodyModel.embedded()


@pytest.fixture(scope="session")
def scene(body: BodyModel) -> TrueScene:
    """Two people, 150 frames."""
    return true_scene(body, (("walk.npz", -1.0), ("dance_b.npz", 1.5)), 150)

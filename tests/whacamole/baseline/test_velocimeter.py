"""The network: one set of numbers in NumPy and in PyTorch, and files that can be trusted."""

import json
from pathlib import Path

import numpy as np
import pytest

from whacamole.baseline.velocimeter import WINDOW, MotionVelocimeter, parameter_shapes
from whacamole.baseline.weights import bundled_weights, load_weights, save_weights, trained_on
from whacamole.errors import BaselineError


def random_weights(seed: int = 0) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    shapes = parameter_shapes().items()
    return {name: (0.1 * rng.normal(size=shape)).astype(np.float32) for name, shape in shapes}


def test_it_has_the_parameters_of_the_released_one() -> None:
    assert MotionVelocimeter(random_weights()).num_parameters == 132_035


def test_numpy_gives_what_torch_gives() -> None:
    torch = pytest.importorskip("torch")
    from whacamole.baseline.network import VelocimeterNetwork

    torch.set_num_threads(1)
    network = VelocimeterNetwork()
    joints = np.random.default_rng(1).normal(size=(3, WINDOW, 15, 3))
    with torch.no_grad():
        expected = network(torch.from_numpy(joints.reshape(3, WINDOW, 45).astype(np.float32))).numpy()
    found = MotionVelocimeter(network.arrays())(joints)
    np.testing.assert_allclose(found, expected, atol=1e-6)
    assert sum(value.numel() for value in network.parameters()) == 132_035


def test_windows_of_any_length_give_what_each_gives_alone() -> None:
    velocimeter = MotionVelocimeter(random_weights())
    rng = np.random.default_rng(2)
    windows = [rng.normal(size=(n, 15, 3)) for n in (5, 64, 5, 1)]
    for window, found in zip(windows, velocimeter.windows(windows), strict=True):
        np.testing.assert_allclose(found, velocimeter(window), atol=1e-6)


def test_the_future_changes_nothing() -> None:
    velocimeter = MotionVelocimeter(random_weights())
    window = np.random.default_rng(3).normal(size=(20, 15, 3))
    np.testing.assert_allclose(velocimeter(window)[:12], velocimeter(window[:12]), atol=1e-6)


def test_a_wrong_shape_is_named() -> None:
    weights = random_weights()
    weights["gru.weight_ih_l1"] = weights["gru.weight_ih_l1"][:-1]
    with pytest.raises(ValueError, match=r"gru\.weight_ih_l1: \(191, 64\), expected \(192, 64\)"):
        MotionVelocimeter(weights)


def test_weights_come_back_as_they_were(tmp_path: Path) -> None:
    weights, path = random_weights(), tmp_path / "w.safetensors"
    save_weights(path, weights, {"motions": json.dumps(["walk"])})
    found = load_weights(path)
    for name, value in weights.items():
        np.testing.assert_array_equal(found.weights[name], value)
    assert trained_on(found) == {"walk"}


def test_the_same_weights_are_the_same_bytes(tmp_path: Path) -> None:
    weights, path = random_weights(), tmp_path / "w.safetensors"
    about = {f"key {number}": str(number) for number in range(8)}
    found = set()
    for _ in range(4):
        save_weights(path, weights, about)
        found.add(path.read_bytes())
    assert len(found) == 1
    assert load_weights(path).about == about


@pytest.mark.parametrize("content", [b"", b"not weights", b"\xff" * 64])
def test_a_damaged_file_is_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "w.safetensors"
    path.write_bytes(content)
    with pytest.raises(BaselineError, match=r"w\.safetensors: no weights of the velocimeter") as caught:
        load_weights(path)
    assert "\n" not in str(caught.value)


def test_the_bundled_weights_for_a_motion_never_saw_it() -> None:
    everything = bundled_weights()
    motions = trained_on(everything)
    assert {"walk", "run", "dance_a"} <= motions
    for motion in motions:
        assert motion not in trained_on(bundled_weights(motion))
    assert bundled_weights("a motion of somebody's own") is everything
    # Motions of one capture are held out together.
    for family in (("walk", "walk_turn", "stroll"), ("dance_b", "duet"), ("kick", "punch", "sparring")):
        assert len({bundled_weights(motion).about["motions"] for motion in family}) == 1

"""Finding motions in a folder: pairs, ids, order, links, and what is left out."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from whacamole.errors import MotionError
from whacamole.motion import find_motions, read_motion


def clip(path: Path, frames: int = 60) -> Path:
    """A valid AMASS SMPL+H file at ``path``."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as stream:
        np.savez(stream, poses=np.zeros((frames, 156)), trans=np.zeros((frames, 3)), mocap_framerate=60.0)
    return path


def half(path: Path, frames: int = 30) -> Path:
    """A valid half of a DD100 pair at ``path``."""
    path.parent.mkdir(parents=True, exist_ok=True)
    values = {
        "poses": np.zeros((frames, 165)),
        "transl": np.zeros((frames, 3)),
        "betas": np.zeros((frames, 10)),
    }
    np.save(path, np.array(values, dtype=object), allow_pickle=True)
    return path


def test_folders_are_searched_and_sorted(tmp_path):
    for name in ("b/z.npz", "b/a.npz", "a/deep/er/c.npz", "top.npz", "B/UPPER.NPZ"):
        clip(tmp_path / name)
    for name in ("notes.txt", ".hidden.npz", ".cache/x.npz", "__MACOSX/y.npz"):
        clip(tmp_path / name)
    ids = [file.id for file in find_motions(tmp_path)]
    assert ids == ["B__UPPER", "a__deep__er__c", "b__a", "b__z", "top"]
    assert [file.num_frames for file in find_motions(tmp_path)] == [30] * 5


def test_one_file_is_a_folder_of_one(tmp_path):
    path = clip(tmp_path / "sub" / "walk.npz")
    [found] = find_motions(path)
    assert (found.id, found.paths) == ("walk", (path,))
    assert read_motion(path).id == "walk"


def test_both_halves_make_one_motion(tmp_path):
    paths = half(tmp_path / "Duet_01_01_00.npy", 30), half(tmp_path / "Duet_01_01_01.npy", 29)
    half(tmp_path / "Duet_01_02_00.npy")
    half(tmp_path / "Duet_01_02_01.npy")
    found = find_motions(tmp_path)
    assert [file.id for file in found] == ["Duet_01_01", "Duet_01_02"]
    assert found[0].paths == paths
    assert found[0].num_frames == 29
    assert found[0].num_people == 2
    # Either half names the pair.
    for path in paths:
        [alone] = find_motions(path)
        assert (alone.id, alone.paths) == ("Duet_01_01", paths)


def test_half_a_pair_is_a_problem_not_a_person(tmp_path):
    half(tmp_path / "Duet_01_01_00.npy")
    clip(tmp_path / "walk.npz")
    found = find_motions(tmp_path)
    assert [file.problem is None for file in found] == [False, True]
    with pytest.raises(MotionError, match=r"Duet_01_01_01\.npy is missing"):
        read_motion(found[0])


def test_a_pair_with_a_bad_half_names_that_half(tmp_path):
    half(tmp_path / "Duet_01_01_00.npy")
    (tmp_path / "Duet_01_01_01.npy").write_bytes(b"")
    with pytest.raises(MotionError, match=r"Duet_01_01_01\.npy: the file is empty"):
        read_motion(tmp_path / "Duet_01_01_00.npy")


def test_takes_of_different_length_are_cut_or_refused(tmp_path):
    half(tmp_path / "a_00.npy", 30), half(tmp_path / "a_01.npy", 33)
    half(tmp_path / "b_00.npy", 30), half(tmp_path / "b_01.npy", 60)
    a, b = find_motions(tmp_path)
    assert read_motion(a).num_frames == 30
    with pytest.raises(MotionError, match="30 and 60 frames"):
        read_motion(b)


def test_a_bad_file_is_listed_beside_the_good_ones(tmp_path):
    clip(tmp_path / "good.npz")
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 no archive")
    np.savez(tmp_path / "unknown.npz", x=np.zeros(3))
    found = {file.id: file for file in find_motions(tmp_path)}
    assert {name for name, file in found.items() if file.problem} == {"bad", "unknown"}
    assert found["good"].problem is None


def test_shape_files_of_amass_are_no_fault_of_the_folder(tmp_path):
    np.savez(tmp_path / "shape.npz", gender="male", betas=np.zeros(16))
    clip(tmp_path / "walk_poses.npz")
    assert [file.id for file in find_motions(tmp_path)] == ["walk_poses"]
    with pytest.raises(MotionError, match="body shape without a motion"):
        read_motion(tmp_path / "shape.npz")


def test_links_out_of_the_folder_are_named_not_followed(tmp_path):
    outside, root = tmp_path / "outside", tmp_path / "root"
    clip(outside / "secret.npz")
    clip(root / "walk.npz")
    (root / "file_link.npz").symlink_to(outside / "secret.npz")
    (root / "folder_link").symlink_to(outside)
    (root / "inner_link.npz").symlink_to(root / "walk.npz")
    found = find_motions(root)
    assert {file.id for file in found if file.problem is None} == {"walk"}
    links = [file for file in found if file.problem]
    assert sorted(file.path.name for file in links) == ["file_link.npz", "folder_link"]
    assert all("leads out of the folder" in str(file.problem) for file in links)


def test_the_root_itself_may_be_a_link(tmp_path):
    clip(tmp_path / "real" / "sub" / "walk.npz")
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert [file.id for file in find_motions(tmp_path / "link")] == ["sub__walk"]


def test_ids_do_not_change_when_motions_are_added(tmp_path):
    for name in ("a/walk.npz", "a__walk.npz", "a b.npz", "ü.npz", "x" * 120 + ".npz"):
        clip(tmp_path / name)
    before = {file.path: file.id for file in find_motions(tmp_path)}
    for name in ("a-b.npz", "-.npz", "0/first.npz", "zz.npz"):
        clip(tmp_path / name)
    after = {file.path: file.id for file in find_motions(tmp_path)}
    assert {path: after[path] for path in before} == before


def test_twins_that_differ_in_suffix_or_case_get_different_ids(tmp_path):
    clip(tmp_path / "walk.npz"), half(tmp_path / "walk.npy"), clip(tmp_path / "Walk.npz")
    ids = [file.id.lower() for file in find_motions(tmp_path)]
    assert len(set(ids)) == 3


NAMES = st.lists(st.text("abcA_-. ä/%", min_size=1, max_size=8), min_size=1, max_size=6)


@given(NAMES)
@settings(
    max_examples=60,
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_ids_are_unique_and_safe(tmp_path_factory, names):
    root = tmp_path_factory.mktemp("names")
    for name in names:
        parts = [part for part in name.split("/") if part.strip(". ") and not part.startswith(".")]
        if parts:
            path = root.joinpath(*parts)
            if not path.exists() and not any(parent.is_file() for parent in path.parents):
                clip(path.with_name(path.name + ".npz"))
    if not any(root.iterdir()):
        return
    found = find_motions(root)
    ids = [file.id for file in found]
    assert len({name.lower() for name in ids}) == len(ids) == len(list(root.rglob("*.npz")))
    assert ids == sorted(ids)
    assert all(re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,109}", name) for name in ids)

"""Pictures: marks painted out, unused parts filled."""

import numpy as np
from open_people.item_list import ITEMS, LOGOS, SKINS, Patch
from open_people.textures import cut_out, encode, fill_unused, paint_out, strands_only, used_pixels


def test_used_pixels_follow_the_uv_map_with_v_up():
    uv = np.array([[0, 1], [0.25, 1], [0.25, 0.75], [0, 0.75]])
    used = used_pixels(uv, np.array([[0, 1, 2, 3]]), (64, 64))
    assert used[:16, :16].all()
    assert not used[22:].any()
    assert not used[:, 22:].any()


def test_unused_parts_take_the_nearest_colour():
    pixels = np.zeros((8, 8, 3))
    pixels[:, :4] = [10, 20, 30]
    pixels[:, 4:] = 255
    used = np.zeros((8, 8), bool)
    used[:, :4] = True
    assert (fill_unused(pixels, used) == [10, 20, 30]).all()


def test_a_patch_covers_the_mark_and_leaves_the_rest():
    rng = np.random.default_rng(0)
    cloth = 100 + rng.normal(0, 3, (100, 100, 3))
    marked = cloth.copy()
    marked[20:40, 20:40] = [255, 0, 0]
    clean = paint_out(marked, (Patch((12, 12, 48, 48), (45, 0)),))
    assert np.abs(clean[20:40, 20:40] - 100).max() < 30
    np.testing.assert_array_equal(clean[60:], cloth[60:])
    np.testing.assert_array_equal(clean[:12], cloth[:12])


def test_what_is_cut_away_takes_the_colour_of_strands_and_marks_outside_the_mesh_go():
    pixels = np.full((32, 32, 4), 255.0)
    pixels[:, :16] = [40, 30, 20, 255]
    pixels[:, 16:, 3] = 0  # white paper, clear
    pixels[:4, 28:] = [255, 0, 0, 255]  # a mark that no face reads
    used = np.zeros((32, 32), bool)
    used[:, :20] = True
    clean = cut_out(pixels, used)
    assert (clean[..., :3] == [40, 30, 20]).all()
    np.testing.assert_array_equal(clean[..., 3] > 0, np.arange(32) < [[16]] * 32)


def test_pictures_of_hair_lose_painted_sheen_and_keep_their_strands():
    rng = np.random.default_rng(0)
    strands = np.exp(rng.normal(0, 0.1, 256))[None, :]
    sheen = np.linspace(0.2, 0.8, 256)[:, None]
    pixels = np.dstack(
        [255 * sheen * strands * tint for tint in (0.9, 0.7, 0.5)] + [np.full((256, 256), 255.0)]
    )
    grey = strands_only(pixels)
    assert (grey[..., 0] == grey[..., 2]).all()
    rows, columns = grey[..., 0].mean(axis=1), grey[..., 0].mean(axis=0)
    assert rows.max() / rows.min() < 2 < (sheen.max() / sheen.min())
    assert np.corrcoef(columns, strands[0])[0, 1] > 0.8
    assert np.log(columns).std() > 1.5 * np.log(strands).std()


def test_pictures_with_alpha_become_webp():
    assert encode(np.zeros((4, 4, 3)))[0] == ".jpg"
    assert encode(np.zeros((4, 4, 4)))[0] == ".webp"
    noise = np.random.default_rng(0).uniform(0, 255, (32, 32, 4))
    assert encode(noise) == encode(noise)


def test_only_listed_core_items_are_taken():
    sources = {item.source for item in ITEMS}
    assert "male_worksuit01" not in sources
    assert not any(word in source for source in sources for word in ("Harvey", "F_", "punk", "toon"))
    assert len({item.name for item in ITEMS}) == len(ITEMS)
    assert set(LOGOS) <= sources
    assert not any("suit" in skin.file for skin in SKINS)
    for age in ("young", "middle", "old"):
        for origin in ("african", "asian", "caucasian"):
            for gender in ("female", "male"):
                assert any((s.age, s.origin, s.gender) == (age, origin, gender) for s in SKINS)

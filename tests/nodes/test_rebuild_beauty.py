"""Rebuild beauty against what Cycles rendered, and by its formula."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from halation.nodes.geometry.rebuild_beauty import RebuildBeauty

LOBES = ("diffuse", "glossy", "transmission")


@cache
def passes() -> dict[str, np.ndarray]:
    """Blender's, opaque as pictures without alpha are."""
    with np.load(Path(__file__).parents[1] / "data" / "blender_passes.npz") as file:
        found = {
            name: np.pad(file[name], ((0, 0), (0, 0), (0, 4 - file[name].shape[2])), constant_values=1.0)
            for name in file.files
        }
    return {"beauty": found.pop("combined"), **found}


def test_the_sum_is_the_render(run):
    given = passes()
    used = [name for name in given if name != "beauty" and given[name][..., :3].max() > 0.0]
    assert len(used) >= 10, "light of nearly every kind is in it"
    np.testing.assert_allclose(run(RebuildBeauty(), given), given["beauty"], rtol=1e-6, atol=2e-5)
    difference = run(RebuildBeauty(), given, output="difference")
    assert 0.0 < difference.max() < 2e-5
    assert run(RebuildBeauty(), given, output="error").ravel() == [difference.max()]


@pytest.mark.parametrize("missing", ["glossy_direct", "emission", "volume_direct"])
def test_a_pass_that_is_missing_shows(run, missing):
    given = passes()
    light = given[missing][..., :3].astype(float)
    if missing == "glossy_direct":
        light = light * given["glossy_color"][..., :3]
    less = {name: array for name, array in given.items() if name != missing}
    difference = run(RebuildBeauty(), less, output="difference")[..., 0]
    np.testing.assert_allclose(difference, light.max(axis=2), atol=2e-5)


def test_every_input_has_its_place(run, hdr):
    """By the formula, on random light; colors that are not linked are white."""
    rng = np.random.default_rng(5)
    given = {name: rng.gamma(1.0, 1.0, (7, 9, 4)) for name in RebuildBeauty.inputs if name != "beauty"}
    for colored in (True, False):
        used = {name: array for name, array in given.items() if colored or not name.endswith("_color")}
        expected = sum(
            used.get(f"{lobe}_color", np.ones(4)) * (used[f"{lobe}_direct"] + used[f"{lobe}_indirect"])
            for lobe in LOBES
        )
        for name in ("volume_direct", "volume_indirect", "emission", "environment", "other"):
            expected = expected + used[name]
        found = run(RebuildBeauty(), used)
        np.testing.assert_allclose(found[..., :3], expected[..., :3], rtol=2e-6)
        alphas = [array[..., 3] for name, array in used.items() if not name.endswith("_color")]
        np.testing.assert_allclose(found[..., 3], np.max(alphas, axis=0), rtol=1e-6)


def test_alpha_is_that_of_the_render(run, hdr):
    picture = hdr(8, 6)
    assert (run(RebuildBeauty(), {"beauty": picture, "emission": picture})[..., 3] == picture[..., 3]).all()
    assert run(RebuildBeauty(), {"beauty": picture, "emission": picture}, output="error").max() == 0.0
    assert (run(RebuildBeauty(), {"emission": picture}, output="difference") == 0.0).all()


def test_nothing_linked_is_nothing(run):
    assert (run(RebuildBeauty(), size=(5, 4)) == 0.0).all()

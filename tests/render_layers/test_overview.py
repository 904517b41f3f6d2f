"""A render in a few words, for people who choose."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from halation.errors import InputError
from halation.presets import sample
from halation.render_layers.analysis import analyze_render
from halation.render_layers.conventions import DepthKind
from halation.render_layers.mattes import IdMap, read_id_map
from halation.render_layers.naming import Role
from halation.render_layers.overview import summarize_render
from halation.render_layers.render import is_render, read_render
from halation.resources.sandbox import UNRESTRICTED

NEON = str(sample())
ROLES = (Role.BEAUTY, Role.DEPTH, Role.NORMAL, Role.POSITION, Role.UV)


@pytest.fixture
def unclear(tmp_path: Path) -> str:
    picture, vector = np.ones((3, 4, 4), np.float32), np.ones((3, 4, 3), np.float32)
    layers = {"beauty": picture, "foo": vector, "worldNormals": vector, "normalsCS": vector}
    return str(write_exr(tmp_path / "x.exr", layers, dict.fromkeys(layers, "float")))


def test_what_is_found():
    seen = summarize_render(NEON, ROLES, sandbox=UNRESTRICTED)
    assert seen.size == "480 x 270, openexr, 12 parts, 12 layers" and "Blender 5.0.1" in seen.maker
    depth = seen.uses[Role.DEPTH]
    assert (depth.layer, depth.found_layer, depth.reason) == ("Depth", "Depth", "Blender's name for depth")
    assert depth.rule and depth.rule.kind is DepthKind.PLANAR and depth.rule.is_measured
    assert seen.uses[Role.UV].layer == "" and not seen.uses[Role.UV].is_open
    assert {item.layer.name for item in seen.other_passes} >= {"Noisy Image", "Vector"}
    assert not any("Crypto" in item.layer.name for item in seen.other_passes) and len(seen.mattes) == 1
    assert seen.camera.solution and len(seen.parts) == 12 and ("Frame", "012") in seen.metadata
    assert seen.report.splitlines()[1].strip() == seen.size and not seen.fault


def test_what_is_open_says_so(unclear):
    uses = summarize_render(unclear, ROLES, sandbox=UNRESTRICTED).uses
    assert uses[Role.NORMAL].is_open and uses[Role.NORMAL].reason == "may be worldNormals or normalsCS: choose one"
    assert uses[Role.POSITION].is_open and uses[Role.POSITION].reason == "may be foo"
    chosen = summarize_render(unclear, ROLES, {Role.NORMAL: "normalsCS"}, sandbox=UNRESTRICTED)
    assert chosen.uses[Role.NORMAL].layer == "normalsCS" and not chosen.uses[Role.NORMAL].is_open
    assert {item.layer.name for item in chosen.other_passes} == {"foo", "worldNormals"}


def test_a_layer_that_is_not_there_leaves_the_rest(unclear):
    seen = summarize_render(NEON, ROLES, {Role.DEPTH: "Depht", Role.UV: "nothing like it"}, sandbox=UNRESTRICTED)
    assert seen.uses[Role.DEPTH].fault == "no layer 'Depht' in this file: did you mean Depth?"
    assert seen.uses[Role.UV].fault == "no layer 'nothing like it' in this file"
    assert seen.uses[Role.NORMAL].layer == "Normal" and seen.camera.solution
    with pytest.raises(InputError, match="has no layer 'Depht': did you mean 'Depth'"):
        read_render(NEON, {"depth": "Depht"}, sandbox=UNRESTRICTED)


def test_conventions_are_those_of_the_chosen_layer(tmp_path):
    """And the camera is solved from the chosen positions."""
    usual = read_render(NEON, sandbox=UNRESTRICTED)
    named = read_render(NEON, {"depth": "Position.Z"}, sandbox=UNRESTRICTED)
    assert usual.meanings["depth"].kind == "planar" and named.layers["depth"].endswith("Position.Z")
    assert (
        not analyze_render(NEON, named={Role.DEPTH: "Position.Z"}, sandbox=UNRESTRICTED)
        .conventions[Role.DEPTH]
        .is_measured
    )
    assert read_render(NEON, {"position": "Normal"}, sandbox=UNRESTRICTED).camera != usual.camera
    assert analyze_render(NEON, sandbox=UNRESTRICTED) is analyze_render(NEON, named={}, sandbox=UNRESTRICTED)


def test_what_is_a_render(tmp_path, unclear):
    assert (
        is_render(NEON, sandbox=UNRESTRICTED)
        and is_render(unclear, sandbox=UNRESTRICTED)
        and not is_render(tmp_path / "gone.exr", sandbox=UNRESTRICTED)
    )
    plain = write_exr(tmp_path / "plain.exr", {"RGBA": np.ones((3, 4, 4), np.float32)}, {"RGBA": "half"})
    alone = write_exr(tmp_path / "depth.exr", {"depth": np.ones((3, 4, 1), np.float32)}, {"depth": "float"})
    assert not is_render(plain, sandbox=UNRESTRICTED) and not is_render(alone, sandbox=UNRESTRICTED)


def test_what_is_where():
    matte = read_render(NEON, sandbox=UNRESTRICTED).mattes[0]
    found = read_id_map(NEON, matte.layers[0], sandbox=UNRESTRICTED)
    assert found.ids.shape == (270, 480) and found.ids.dtype == np.uint32
    assert set(found.names.values()) == set(matte.ids)
    assert found.names[found.id_at(0.5, 0.5)] in matte.ids and found.id_at(1.5, 0.5) == found.id_at(-0.1, 0.5) == 0
    corners = {(0.0, 0.0): (0, 0), (1.0 - 1e-9, 0.0): (0, 479), (0.0, 1.0 - 1e-9): (269, 0), (0.5, 0.25): (67, 240)}
    assert all(found.id_at(*at) == found.ids[pixel] for at, pixel in corners.items())
    outside = [(1.0, 0.5), (0.5, 1.0), (-1e-9, 0.5), (0.5, -1e-9)]
    whole = IdMap(np.full_like(found.ids, 7), {})
    assert [whole.id_at(*at) for at in outside] == [0] * 4 and whole.id_at(0.0, 0.0) == 7
    with pytest.raises(InputError, match="is no cryptomatte"):
        read_id_map(NEON, "Depth", sandbox=UNRESTRICTED)

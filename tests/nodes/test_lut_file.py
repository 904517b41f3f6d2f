"""LUT File against OpenColorIO's own CPU path, on files written here."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio
import pytest
from conftest import graph_of
from halation.errors import InputError
from halation.graph import Port
from halation.nodes.color._spaces import SPACES
from halation.nodes.color.lut_file import LutFile
from halation.renderer import RenderRequest


def twisted(rgb: np.ndarray) -> np.ndarray:
    """A look that mixes channels and bends tones."""
    bent = rgb ** np.array([0.8, 1.1, 1.3])
    return np.clip(bent @ np.array([[0.9, 0.05, 0.0], [0.1, 0.85, 0.15], [0.0, 0.1, 0.85]]) + 0.02, 0, 1)


def lines(rows: np.ndarray) -> str:
    return "".join(" ".join(f"{x:g}" for x in row) + "\n" for row in rows.round(6))


def cube(path: Path, edge: int = 9) -> Path:
    """A .cube of three dimensions, red running fastest."""
    blue, green, red = np.meshgrid(*[np.linspace(0, 1, edge)] * 3, indexing="ij")
    rows = twisted(np.stack([red, green, blue], -1).reshape(-1, 3))
    path.write_text(f"LUT_3D_SIZE {edge}\n" + lines(rows))
    return path


def cube_1d(path: Path) -> Path:
    rows = np.linspace(0, 1, 33)[:, None] ** np.array([0.5, 1.0, 2.0])
    path.write_text("LUT_1D_SIZE 33\n" + lines(rows))
    return path


def three_dl(path: Path) -> Path:
    """A .3dl, blue running fastest, 12 bits."""
    edge = 17
    red, green, blue = np.meshgrid(*[np.linspace(0, 1, edge)] * 3, indexing="ij")
    rows = np.rint(twisted(np.stack([red, green, blue], -1).reshape(-1, 3)) * 4095).astype(int)
    head = " ".join(str(round(x)) for x in np.linspace(0, 1023, edge))
    path.write_text(head + "\n" + lines(rows))
    return path


def cc(path: Path) -> Path:
    path.write_text(
        '<ColorCorrection id="warm"><SOPNode><Slope>1.2 1.0 0.8</Slope><Offset>0.01 0 -0.01</Offset>'
        "<Power>1.1 1.0 0.9</Power></SOPNode><SatNode><Saturation>0.8</Saturation></SatNode></ColorCorrection>"
    )
    return path


FILES = {"a.cube": cube, "b.cube": cube_1d, "c.3dl": three_dl, "d.cc": cc}


def reference(rgb: np.ndarray, path: Path, takes: str, gives: str, *, inverse: bool = False) -> np.ndarray:
    config = ocio.Config.CreateFromBuiltinConfig("ocio://studio-config-latest")
    way = ocio.TRANSFORM_DIR_INVERSE if inverse else ocio.TRANSFORM_DIR_FORWARD
    first, last = (gives, takes) if inverse else (takes, gives)
    out = np.array(rgb, np.float32).reshape(-1, 3)
    for step in (
        ocio.ColorSpaceTransform("lin_rec709_scene", SPACES[first]),
        ocio.FileTransform(str(path), interpolation=ocio.INTERP_BEST, direction=way),
        ocio.ColorSpaceTransform(SPACES[last], "lin_rec709_scene"),
    ):
        config.getProcessor(step).getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS).applyRGB(out)
    return out.reshape(rgb.shape)


def opaque(rgb: np.ndarray) -> np.ndarray:
    return np.concatenate([rgb, np.ones((*rgb.shape[:2], 1))], -1).astype(np.float32)


@pytest.mark.parametrize(("takes", "gives"), [("linear rec709", "linear rec709"), ("acescct", "srgb")], ids="-".join)
@pytest.mark.parametrize("name", FILES)
def test_it_is_opencolorio(run, tmp_path, name, takes, gives):
    path = FILES[name](tmp_path / name)
    rgb = np.random.default_rng(6).uniform(-0.1, 1.3, (11, 29, 3)).astype(np.float32)
    out = run(LutFile(file=str(path), takes=takes, gives=gives), {"image": opaque(rgb)})
    expected = reference(rgb, path, takes, gives)
    assert (np.abs(out[..., :3] - expected) / np.maximum(np.abs(expected), 1.0)).max() < 1e-5
    assert (out[..., 3] == 1).all()


@pytest.mark.parametrize("name", ["b.cube", "d.cc"])
def test_a_table_with_an_inverse_is_undone(run, tmp_path, name):
    path = FILES[name](tmp_path / name)
    rgb = np.random.default_rng(7).uniform(0.05, 0.8, (5, 9, 3)).astype(np.float32)
    there = run(LutFile(file=str(path), gives="srgb"), {"image": opaque(rgb)})
    back = run(LutFile(file=str(path), gives="srgb", inverse=True), {"image": there})
    assert np.abs(back[..., :3] - rgb).max() < 1e-3  # between the 33 points of a table
    expected = reference(there[..., :3], path, "linear rec709", "srgb", inverse=True)
    assert np.abs(back[..., :3] - expected).max() < 1e-5


def test_two_tables_share_a_pass(renderer, tmp_path, run, hdr):
    picture = np.clip(hdr(9, 7, opaque=True), 0, 1)
    first, second = LutFile(file=str(cube(tmp_path / "a.cube"))), LutFile(file=str(cube(tmp_path / "b.cube", 5)))
    chain = graph_of(first, {"image": picture}).add("second", second)
    chain = chain.connect(Port("node", "out"), Port("second", "image"))
    chain = chain.connect(Port("second", "out"), Port("outputs", "out"))
    assert len(renderer.compile(chain, RenderRequest({"image": picture}, precision="float")).passes) == 1
    expected = run(second, {"image": run(first, {"image": picture})})
    np.testing.assert_array_equal(run(chain, {"image": picture}), expected)


def test_mixing_and_coverage(run, tmp_path, hdr):
    path = cube(tmp_path / "a.cube")
    picture = np.clip(hdr(9, 7, opaque=True), 0, 1)
    full = run(LutFile(file=str(path)), {"image": picture})
    mixed = run(LutFile(file=str(path), amount=0.25), {"image": picture})
    assert np.abs(mixed - (0.25 * full + 0.75 * picture)).max() < 1e-6
    half = run(LutFile(file=str(path)), {"image": picture * np.float32(0.5)})
    assert np.abs(half - 0.5 * full).max() < 1e-6


def test_a_changed_file_is_read_again(run, tmp_path):
    path = cube(tmp_path / "a.cube")
    picture = opaque(np.full((1, 1, 3), 0.5))
    before = run(LutFile(file=str(path)), {"image": picture})
    cube_1d(path)
    assert np.abs(run(LutFile(file=str(path)), {"image": picture}) - before).max() > 0.01


def test_what_is_no_table_is_named(run, tmp_path):
    picture = {"image": opaque(np.zeros((1, 1, 3)))}
    with pytest.raises(InputError, match=r"gone\.cube: there is no such file"):
        run(LutFile(file=str(tmp_path / "gone.cube")), picture)
    broken = tmp_path / "broken.cube"
    broken.write_text("LUT_3D_SIZE 2\n0 0 0\n")
    with pytest.raises(InputError, match=r"broken\.cube: is no color table that can be read: "):
        run(LutFile(file=str(broken)), picture)


def test_without_a_file_the_picture_passes():
    assert LutFile().identity() == "image" and LutFile(file="x.cube").identity() is None

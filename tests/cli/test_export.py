"""halation export: kinds, and tables of colors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import PyOpenColorIO as ocio
import pytest
from exr_files import read, write_exr

GRADE = {
    "nodes": {
        "light": {"type": "exposure", "values": {"stops": 0.5}},
        "tone": {"type": "tone_map"},
        "color": {"type": "saturation", "values": {"saturation": 1.4}},
    },
    "links": {"color.image": "light.out", "tone.image": "color.out", "outputs.image": "tone.out"},
}


def random_light(seed: int, high: float = 8.0) -> np.ndarray:
    """Opaque colors of a picture, most of them dark."""
    pixels = np.ones((40, 50, 4), np.float32)
    pixels[..., :3] = np.random.default_rng(seed).random((40, 50, 3)) ** 3 * high
    return pixels.astype(np.float16).astype(np.float32)


@pytest.fixture
def light(tmp_path: Path) -> Path:
    return write_exr(tmp_path / "light.exr", {"Combined": random_light(3)}, {"Combined": "half"})


def apply_by_ocio(path: Path, colors: np.ndarray) -> np.ndarray:
    """What OpenColorIO makes of colors by a table."""
    transform = ocio.FileTransform(str(path), interpolation=ocio.INTERP_TETRAHEDRAL)
    changed = np.ascontiguousarray(colors[..., :3]).copy()
    ocio.Config.CreateRaw().getProcessor(transform).getDefaultCPUProcessor().applyRGB(changed)
    return changed


@pytest.mark.parametrize("ending", ["cube", "clf"])
def test_a_table_is_the_graph_for_every_program(cli, graphs, light, tmp_path: Path, ending: str) -> None:
    """OpenColorIO's processor, the node lut_file and the figures of --check say the same."""
    graph, table = graphs(**GRADE), tmp_path / f"look.{ending}"
    figures = cli("export", graph, "-o", table, "-i", f"beauty={light}", "--check", "--lut-size", "49", "--json").json
    assert (figures["shaper"], figures["low"], figures["high"], figures["side"]) == ("logarithm", 0.0, 8.0, 49)
    rendered, applied = tmp_path / "graph.exr", tmp_path / "applied.exr"
    words = ("-i", f"beauty={light}", "--precision", "float")
    assert cli("render", graph, "-o", rendered, *words).code == 0
    look = {"look": {"type": "lut_file", "values": {"file": str(table)}}}
    links = {"look.image": "inputs.beauty", "outputs.image": "look.out"}
    again = graphs("again.json", nodes=look, links=links)
    assert cli("render", again, "-o", applied, *words).code == 0
    errors = np.abs(apply_by_ocio(table, random_light(3)) - read(rendered)[..., :3])
    assert errors.max() == pytest.approx(figures["largest_error"], abs=2e-5) and errors.max() < 0.02
    assert errors.mean() == pytest.approx(figures["mean_error"], abs=2e-6) and errors.mean() < 0.001
    assert np.abs(read(applied)[..., :3] - apply_by_ocio(table, random_light(3))).max() < 2e-4


def test_a_strip_holds_the_codes_of_a_display(cli, graphs, tmp_path: Path) -> None:
    """Blue from square to square, red to the right, green downward; read by OpenImageIO and compared with a render."""
    graph, strip = graphs(**GRADE), tmp_path / "look.png"
    figures = cli("export", graph, "-o", strip, "--lut-size", "17", "--check", "--json").json
    assert (figures["encoding"], figures["shaper"]) == ("srgb", "none") and figures["mean_error"] < 0.005
    pixels = oiio.ImageBuf(str(strip)).get_pixels("float")
    assert pixels.shape == (17, 289, 3) and oiio.ImageBuf(str(strip)).spec().format == "uint16"
    codes = np.array([[[r, g, b, 16] for r, g, b in ((3, 9, 12), (16, 0, 5), (8, 8, 8))]], np.float32) / 16
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4).astype(np.float32)
    picture = write_exr(tmp_path / "codes.exr", {"Combined": linear}, {"Combined": "float"})
    assert cli("render", graph, "-o", tmp_path / "a.exr", "-i", f"beauty={picture}", "--precision", "float").code == 0
    rendered = read(tmp_path / "a.exr")[0, :, :3]
    expected = np.where(rendered <= 0.0031308, rendered * 12.92, 1.055 * rendered ** (1 / 2.4) - 0.055)
    found = [pixels[9, 12 * 17 + 3], pixels[0, 5 * 17 + 16], pixels[8, 8 * 17 + 8]]
    np.testing.assert_allclose(found, np.clip(expected, 0, 1), atol=2e-5)


def test_a_table_of_codes_has_even_steps_that_every_program_reads(cli, graphs, tmp_path: Path) -> None:
    table = tmp_path / "look.cube"
    assert cli("export", graphs(**GRADE), "-o", table, "--encoding", "srgb", "--lut-size", "5").code == 0
    text = table.read_text()
    assert "LUT_3D_SIZE 5" in text and "LUT_1D_SIZE" not in text
    assert "LUT_1D_SIZE" in (cli("export", graphs(**GRADE), "-o", table), table.read_text())[1]


def test_bright_light_is_limited_in_a_cube_and_not_in_a_clf(cli, graphs, tmp_path: Path) -> None:
    bright = write_exr(tmp_path / "bright.exr", {"Combined": random_light(5, 900.0)}, {"Combined": "half"})
    words = (graphs(), "-i", f"beauty={bright}", "--lut-size", "9", "--json")
    cube = cli("export", *words, "-o", tmp_path / "a.cube")
    assert cube.json["high"] == 64.0 and "light above 64 becomes 64" in cube.json["notes"][0]
    assert cli("export", *words, "-o", tmp_path / "a.clf").json["high"] == 1024.0
    chosen = cli("export", *words, "-o", tmp_path / "b.clf", "--range", "-0.5,4").json
    assert (chosen["low"], chosen["high"]) == (-0.5, 4.0)
    colors = np.array([[[-0.25, 0.0, 1.0], [3.5, 0.01, 0.2]]], np.float32)
    np.testing.assert_allclose(apply_by_ocio(tmp_path / "b.clf", colors), colors * 2.0, atol=0.2)


@pytest.mark.parametrize(
    ("node", "reason"),
    [
        ({"type": "gaussian_blur", "values": {"sigma": 2.0}}, "'n' reads other pixels"),
        ({"type": "vignette"}, "'n' depends on the place in the picture"),
        ({"type": "film_grain"}, "'n' "),
        ({"type": "feedback"}, "'n' "),
        ({"type": "auto_exposure"}, "'n' "),
    ],
)
def test_what_is_no_function_of_color_is_refused(cli, graphs, tmp_path: Path, node, reason: str) -> None:
    graph = graphs(nodes={"n": node}, links={"n.image": "light.out", "outputs.image": "n.out"})
    result = cli("export", graph, "-o", tmp_path / "no.cube")
    assert result.code == 3 and reason in result.err and "--select" in result.err
    assert not (tmp_path / "no.cube").exists()
    assert cli("export", graph, "-o", tmp_path / "yes.cube", "--select", "light", "--lut-size", "3").code == 0


def test_masks_files_and_alpha_are_refused(cli, graphs, shot, tmp_path: Path) -> None:
    out = ("-o", tmp_path / "no.clf")
    masked = graphs(
        inputs={"beauty": {"type": "Image"}, "cut": {"type": "Field"}},
        links={"light.stops": "inputs.cut"},
    )
    assert "depends on inputs beauty, cut" in cli("export", masked, *out).err
    other = {"pic": {"type": "read_image", "values": {"path": str(shot)}}, "mix": {"type": "merge"}}
    links = {"mix.a": "light.out", "mix.b": "pic.out", "outputs.image": "mix.out"}
    assert "reads the file" in cli("export", graphs(nodes=other, links=links), *out).err
    flat = graphs(nodes={"fill": {"type": "constant"}}, links={"outputs.image": "fill.out"})
    assert "depends on no input" in cli("export", flat, *out).err
    cut = {"key": {"type": "luma_key"}}
    links = {"key.image": "light.out", "outputs.image": "key.out"}
    assert "holds no alpha" in cli("export", graphs(nodes=cut, links=links), *out).err
    assert not (tmp_path / "no.clf").exists()


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["-o", "a.xyz"], 2, "its ending does not say"),
        ([], 2, "say what to write with --to"),
        (["--to", "book"], 2, "choose one of isf, web"),
        (["--to", "cube"], 2, "name the file"),
        (["-o", "a.cube", "--lut-size", "1"], 2, "--lut-size 1"),
        (["-o", "a.cube", "--range", "3"], 2, "--range 3"),
        (["-o", "a.cube", "--range", "3,1"], 2, "less than"),
        (["-o", "a.cube", "--encoding", "log"], 2, "--encoding log"),
        (["-o", "a.png", "--encoding", "linear"], 2, "srgb"),
        (["-o", "a.cube", "--encoding", "srgb", "--range", "0,4"], 2, "display codes"),
        (["-o", "none/a.cube"], 1, "none"),
    ],
)
def test_mistakes(cli, graphs, words: list[str], code: int, said: str) -> None:
    result = cli("export", graphs(), *words)
    assert (result.code, "Traceback" in result.err) == (code, False) and said in result.err, result.err


def test_the_kind_follows_from_the_ending(cli, graphs, tmp_path: Path) -> None:
    assert cli("export", graphs(), "-o", tmp_path / "a.fs").code == 0
    assert (tmp_path / "a.fs").read_text() == cli("export", graphs(), "--to", "isf").out

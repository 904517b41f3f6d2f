"""Results that end as half floats may be that on the device already: the files are the same to the byte."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from halation import document
from halation.graph import Graph
from halation.media.pictures.finite import to_half
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.jobs.destinations import OutputSettings, plan_destinations, select_half_outputs
from halation.renderer.jobs.job import run_job
from halation.resources.sandbox import UNRESTRICTED

ONLY = frozenset({"image"})


def graph_with(nodes: str, links: str, outputs: str = '"image": {"type": "Image"}', more: str = "") -> Graph:
    inputs = '"image": {"type": "Image"}, "depth": {"type": "Field"}'
    text = f'"inputs": {{{inputs}}}, "outputs": {{{outputs}}}, "nodes": {{{nodes}}}, "links": {{{links}}}{more}'
    return document.loads(f'{{"halation": 1, {text}}}', sandbox=UNRESTRICTED)


def through(code: str = "image") -> Graph:
    """Every number as it is, or code that makes others of them."""
    node = f'"same": {{"type": "glsl", "code": ["vec4 same(vec4 image) {{ return {code}; }}"]}}'
    return graph_with(node, '"same.image": "inputs.image", "outputs.image": "same.out"')


@pytest.fixture(scope="module", params=["compute", "fragment"])
def engine(request):
    made = Renderer(open_device(request.param, sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    if not made.device.target.rounds_halves:
        pytest.skip("this driver rounds for itself")
    yield made
    made.close()


def all_that_matters() -> np.ndarray:
    """Every half, what is halfway between two, one step of a float beside that, and what has no half: [h, 64, 4]."""
    halves_ = np.arange(2**16, dtype=np.uint16).view(np.float16)
    exact = np.unique(halves_[np.isfinite(halves_)].astype(np.float64))
    between = ((exact[1:] + exact[:-1]) / 2.0).astype(np.float32)
    infinite = np.float32(np.inf)
    parts = [
        exact.astype(np.float32),
        between,
        np.nextafter(between, infinite),
        np.nextafter(between, -infinite),
        np.array([0.0, -0.0, 65519.996, 65520.0, 65536.0, 1e30, -1e30, np.inf, -np.inf, np.nan, -np.nan], np.float32),
        np.array([1, 0x80000001, 0x007FFFFF, 0x33000000, 0x33000001], np.uint32).view(np.float32),
    ]
    numbers = np.concatenate(parts)
    return np.resize(numbers, (-(-numbers.size // 256), 64, 4))


def test_a_pass_rounds_as_the_processor_does(engine):
    """To nearest, ties to even; beyond 65504 clamped; subnormal halves too. numpy is the reference."""
    given = {"image": all_that_matters()}
    whole = engine.render(through(), RenderRequest(given))["image"]
    found = engine.render(through(), RenderRequest(given, halves=ONLY))["image"]
    assert (whole.dtype, found.dtype) == (np.float32, np.float16)
    with np.errstate(over="ignore"):
        expected = np.clip(whole, -65504.0, 65504.0).astype(np.float16)
    number = ~np.isnan(expected)
    assert number.sum() > 250_000
    np.testing.assert_array_equal(found.view(np.uint16)[number], expected.view(np.uint16)[number])
    assert np.isnan(found[~number]).all() and (~number).any()


def test_in_a_file_not_a_number_is_always_the_same(engine):
    """Drivers and processors have different NaNs."""
    given = {"image": all_that_matters()}
    whole, found = (
        engine.render(through(), RenderRequest(given, halves=kept))["image"] for kept in (frozenset(), ONLY)
    )
    assert to_half(whole).tobytes() == to_half(found).tobytes()
    numbers = np.array([[[0x7F800001, 0xFFC00000, 0x7FFFFFFF]]], np.uint32).view(np.float32)
    assert set(to_half(numbers).view(np.uint16).flat) == {0x7E00}


def test_infinite_halves_are_clamped_in_files():
    assert to_half(np.array([[[np.inf, -np.inf, 1.0]]], np.float16)).tolist() == [[[65504.0, -65504.0, 1.0]]]
    plain = np.ones((4, 3, 2), np.float16)
    assert to_half(plain) is plain


@pytest.mark.parametrize("code", ["image", "vec4(sin(image.rgb * 3e4) * 7e4, image.a)", "image / 3.0"])
def test_files_are_the_same_to_the_byte(engine, tmp_path, monkeypatch, code):
    given = RenderRequest({"image": all_that_matters()})
    folders = [tmp_path / "half", tmp_path / "float"]
    for folder in folders:
        folder.mkdir()
        run_job(engine, through(code), given, OutputSettings((("", folder / "out.exr"),), compression="none"))
        monkeypatch.setattr("halation.renderer.jobs.item_session.select_half_outputs", lambda *_: frozenset())
    one, other = (_pixels(folder / "out.exr") for folder in folders)
    assert one.dtype == np.float16 and one.tobytes() == other.tobytes()


def _pixels(path: Path) -> np.ndarray:
    import OpenImageIO as oiio

    return np.asarray(oiio.ImageBuf(str(path)).get_pixels(oiio.HALF))


LIT = '"light": {"type": "exposure", "values": {"stops": 0.3}}, "soft": {"type": "gaussian_blur"}'
CHAIN = '"light.image": "inputs.image", "soft.image": "light.out", "outputs.image": "soft.out"'


def test_in_between_all_stays_as_it_was(engine):
    """The output alone is narrow; what other passes read, or another output shows, is not."""
    given = RenderRequest({"image": np.ones((9, 11, 4), np.float32)}, halves=ONLY)
    plan = engine.compile(graph_with(LIT, CHAIN), given)
    depths = {plan.surfaces[number].depth for one in plan.passes for number in one.textures}
    assert depths == {"f4"} and plan.surfaces[plan.outputs["image"]].depth == "f2"
    two = '"image": {"type": "Image"}, "light": {"type": "Image"}'
    links = f'{CHAIN}, "outputs.light": "light.out"'
    for kept in (frozenset({"light"}), frozenset({"image", "light"})):
        plan = engine.compile(graph_with(LIT, links, two), RenderRequest(given.inputs, halves=kept))
        assert plan.surfaces[plan.outputs["light"]].depth == "f4"  # the blur reads it
    same = engine.compile(graph_with(LIT, f'{CHAIN}, "outputs.light": "soft.out"', two), given)
    assert same.surfaces[same.outputs["image"]].depth == "f4"  # the other output wants all of it


def test_what_is_remembered_is_not_rounded(engine):
    graph = graph_with(
        '"trail": {"type": "frame_blend"}',
        '"trail.image": "inputs.image", "outputs.image": "trail.out"',
        more=', "settings": {"frames": [1, 4]}',
    )
    given = RenderRequest({"image": np.ones((9, 11, 4), np.float32)}, halves=ONLY, precision="float")
    plan = engine.compile(graph, given)
    assert plan.memories and not any(memory.half for memory in plan.memories.values())
    assert plan.surfaces[plan.outputs["image"]].depth == "f4"


def test_results_of_both_kinds_are_not_mixed_up(engine):
    """Keys differ, so what is kept of one is not taken for the other."""
    given = {"image": np.full((3, 5, 4), 1.0 / 3.0, np.float32)}
    for _ in range(2):
        assert engine.render(through(), RenderRequest(given))["image"][0, 0, 0] == np.float32(1.0 / 3.0)
        assert engine.render(through(), RenderRequest(given, halves=ONLY))["image"][0, 0, 0] == np.float16(1.0 / 3.0)


@pytest.mark.parametrize(
    ("names", "more", "expected"),
    [
        (["o.exr"], {}, True),
        (["o.exr"], {"precision": "float"}, False),
        (["o.exr"], {"space": "ACEScg"}, False),
        (["o.png"], {}, False),
        (["o.exr", "o.png"], {}, False),
        (["o.exr", "p.exr"], {}, True),
        (["o.mov"], {}, False),
        (["o.hdr"], {}, False),
        (["o.exr"], {"view": "none"}, True),
    ],
)
def test_only_what_no_file_wants_more_of(tmp_path, names, more, expected):
    graph, wanted = through(), RenderRequest()
    writing = OutputSettings([("image", tmp_path / name) for name in names], **more)
    files = plan_destinations(graph, wanted, writing, (1,), sandbox=UNRESTRICTED)[1]
    assert select_half_outputs(files, writing) == (ONLY if expected else frozenset())


def test_data_is_never_rounded(tmp_path):
    graph = graph_with(
        "",
        '"outputs.depth": "inputs.depth", "outputs.image": "inputs.image"',
        '"depth": {"type": "Field"}, "image": {"type": "Image"}',
    )
    writing = OutputSettings((("", tmp_path / "o.exr"),))
    assert (
        select_half_outputs(plan_destinations(graph, RenderRequest(), writing, (1,), sandbox=UNRESTRICTED)[1], writing)
        == ONLY
    )
    assert not list(tmp_path.iterdir())

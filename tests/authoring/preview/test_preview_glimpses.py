"""What can be seen of a picture is computed before the rest, and is the same to the bit; the rest follows."""

from __future__ import annotations

import time

import numpy as np
import pytest
from conftest import graph_of
from device_textures import read_texture
from halation.authoring.preview import Preview, VisibleRegion
from halation.authoring.preview.visible_region import GRID, PictureRegion
from halation.compiler import Region
from halation.graph import Graph, Port
from halation.nodes import catalogue
from halation.nodes.color.exposure import Exposure
from halation.nodes.time.light_trails import LightTrails
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from previews import IMAGE, chain, pixels, request_preview, settle

WIDTH, HEIGHT = 1001, 701
PICTURE = np.random.default_rng(8).random((HEIGHT, WIDTH, 4), np.float32)
SEEN = VisibleRegion((0.25, 0.4, 0.45, 0.6), (WIDTH, HEIGHT), frozenset({"A"}))
BINDINGS = {"image": PICTURE}


def part(preview: Preview, engine: Renderer, name: str = "A") -> tuple[np.ndarray, Region]:
    """What is seen of a picture, and where that lies in it."""
    seen = preview.find_visible_image(name)
    pixels = read_texture(engine.device, seen.texture)
    return pixels[..., : seen.channels], Region(*seen.start, *seen.texture.size)


def of(picture: np.ndarray, region: Region) -> np.ndarray:
    return picture[slice(*region.down), slice(*region.across)]


def until_seen(preview: Preview) -> None:
    """Work until what can be seen is there."""
    for _ in range(10_000):
        assert preview.work(0.0)
        if preview.completing:
            return
        time.sleep(0.0002)
    raise AssertionError("it never comes")


def texels(engine: Renderer, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many pixels each pass makes from now on."""
    made: list[int] = []
    executor = engine.runner._executor
    execute = executor.execute_in_bands

    def counted(plan, one, lease, seconds):
        made.append(max(plan.surfaces[number].size[0] * plan.surfaces[number].size[1] for number in one.targets))
        return execute(plan, one, lease, seconds)

    monkeypatch.setattr(executor, "execute_in_bands", counted)
    return made


def whole(engine: Renderer, graph: Graph, port: Port = IMAGE) -> np.ndarray:
    """By a renderer that has computed nothing else."""
    other = Renderer(engine.device, sandbox=UNRESTRICTED)
    try:
        return other.render(graph, RenderRequest(BINDINGS, {"x": port}))["x"]
    finally:
        other.close()


@pytest.mark.large
def test_while_a_value_is_dragged_only_what_is_seen_is_computed(preview, engine, monkeypatch):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse, made = SEEN, texels(engine, monkeypatch)
    before = preview.find_whole_image("A")
    for step in range(1, 6):
        request_preview(preview, chain(stops=1.0 + 0.1 * step), bindings=BINDINGS)
        until_seen(preview)
        got, region = part(preview, engine)
        assert preview.find_visible_image("A").partial and SEEN.region((WIDTH, HEIGHT)) == region
        np.testing.assert_array_equal(got, of(whole(engine, chain(stops=1.0 + 0.1 * step)), region))
        assert preview.find_whole_image("A") is before, "what needs all of it still has the last one"
    assert max(made) < 0.15 * WIDTH * HEIGHT, "no pass makes more than is seen, and what the blur reads around it"
    settle(preview)
    assert (
        not preview.find_visible_image("A").partial
        and preview.find_visible_image("A") == preview.find_whole_image("A") != before
    )
    np.testing.assert_array_equal(pixels(preview, engine), whole(engine, chain(stops=1.5)))


def test_what_is_there_already_is_not_made_again(preview, engine, monkeypatch):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse, made = SEEN, texels(engine, monkeypatch)
    request_preview(preview, chain(saturation=0.1), bindings=BINDINGS)
    until_seen(preview)
    assert len(made) == 1, "the blurred picture is whole, and read as it is"
    got, region = part(preview, engine)
    np.testing.assert_array_equal(got, of(whole(engine, chain(saturation=0.1)), region))
    request_preview(preview, chain(), bindings=BINDINGS)
    before = len(made)
    settle(preview)
    assert not preview.find_visible_image("A").partial and len(made) == before


def test_the_rest_waits_until_the_graph_stays_as_it_is(preview, engine, monkeypatch):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse, made, seconds = SEEN, texels(engine, monkeypatch), [7.0]
    preview.clock = lambda: seconds[0]
    request_preview(preview, chain(stops=2.0), bindings=BINDINGS)
    until_seen(preview)
    seen, count = preview.find_visible_image("A"), len(made)
    for second in (7.0, 7.19):
        seconds[0] = second
        assert preview.work(0.0) and len(made) == count and preview.find_visible_image("A") == seen
    seconds[0] = 7.21
    settle(preview)
    assert (
        len(made) > count
        and preview.find_visible_image("A").size == (WIDTH, HEIGHT)
        and not preview.find_visible_image("A").partial
    )


def test_panning_computes_what_comes_into_view(preview, engine):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse = SEEN
    request_preview(preview, chain(stops=2.0), bindings=BINDINGS)
    until_seen(preview)
    first = preview.find_visible_image("A")
    a_little = GRID / 2 / WIDTH
    preview.glimpse = VisibleRegion((0.25 + a_little, 0.4, 0.45 + a_little, 0.6), SEEN.picture, SEEN.names)
    preview.work(0.0)
    assert preview.completing and preview.find_visible_image("A") is first, "there is a margin"
    preview.glimpse = VisibleRegion((0.7, 0.1, 0.9, 0.3), SEEN.picture, SEEN.names)
    preview.work(0.0)
    assert not preview.completing
    until_seen(preview)
    got, region = part(preview, engine)
    assert (
        PictureRegion(region, (WIDTH, HEIGHT)).shows(preview.glimpse) and preview.find_visible_image("A") is not first
    )
    np.testing.assert_array_equal(got, of(whole(engine, chain(stops=2.0)), region))
    settle(preview)
    assert not preview.find_visible_image("A").partial


@pytest.mark.parametrize("box", [(0.0, 0.0, 1.0, 1.0), (0.1, 0.1, 0.9, 0.9)])
def test_where_most_can_be_seen_all_is_computed_at_once(preview, engine, box):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse = VisibleRegion(box, SEEN.picture, SEEN.names)
    request_preview(preview, chain(stops=2.0), bindings=BINDINGS)
    while preview.work(0.0):
        assert not preview.find_visible_image("A").partial
        time.sleep(0.0005)
    np.testing.assert_array_equal(pixels(preview, engine), whole(engine, chain(stops=2.0)))


def test_zooming_out_while_a_part_is_shown(preview, engine):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse = SEEN
    request_preview(preview, chain(stops=2.0), bindings=BINDINGS)
    until_seen(preview)
    preview.glimpse = None
    settle(preview)
    np.testing.assert_array_equal(pixels(preview, engine), whole(engine, chain(stops=2.0)))


@pytest.mark.parametrize("id", ["auto_exposure", "photoreceptor_tone_map", "lens_distortion", "bloom", "glass"])
def test_nodes_that_need_everything_stay_right(preview, engine, id):
    def graph(stops: float) -> Graph:
        found = graph_of(catalogue()[id](), {"image": PICTURE})
        light = next(port for port, source in found.links.items() if source == Port("inputs", "image"))
        found = found.disconnect(light).add("light", Exposure(stops=stops))
        return found.connect(Port("inputs", "image"), Port("light", "image")).connect(Port("light", "out"), light)

    ports = {"A": Port("outputs", next(iter(graph(0.0).outputs)))}
    request_preview(preview, graph(0.0), ports, bindings=BINDINGS)
    settle(preview)
    preview.glimpse = SEEN
    request_preview(preview, graph(1.0), ports, bindings=BINDINGS)
    until_seen(preview)
    got, region = part(preview, engine)
    settle(preview)
    assert region.size != (WIDTH, HEIGHT)
    np.testing.assert_array_equal(got, of(pixels(preview, engine), region))


def test_a_proxy_shows_the_same_part(preview, engine):
    glimpse = VisibleRegion(SEEN.box, (2 * WIDTH, 2 * HEIGHT), SEEN.names)
    bindings = {"image": np.random.default_rng(3).random((2 * HEIGHT, 2 * WIDTH, 4), np.float32)}
    request_preview(preview, chain(), bindings=bindings, scale=0.5)
    settle(preview)
    preview.glimpse = glimpse
    request_preview(preview, chain(stops=2.0), bindings=bindings, scale=0.5)
    until_seen(preview)
    got, region = part(preview, engine)
    seen = preview.find_visible_image("A")
    assert (seen.size, seen.full_size, seen.scale) == ((WIDTH, HEIGHT), (2 * WIDTH, 2 * HEIGHT), 0.5)
    settle(preview)
    np.testing.assert_array_equal(got, of(pixels(preview, engine), region))


def test_both_sides_that_are_compared_are_seen_in_part(preview, engine):
    ports = {"A": IMAGE, "B": Port("blur", "out"), "depth": Port("light", "out")}
    request_preview(preview, chain(), ports, bindings=BINDINGS)
    settle(preview)
    preview.glimpse = VisibleRegion(SEEN.box, SEEN.picture, frozenset("AB"))
    request_preview(preview, chain(stops=2.0), ports, bindings=BINDINGS)
    until_seen(preview)
    for name in "AB":
        got, region = part(preview, engine, name)
        np.testing.assert_array_equal(got, of(whole(engine, chain(stops=2.0), ports[name]), region))
    assert not preview.find_visible_image("depth").partial, "what nobody looks at comes with the rest"
    settle(preview)
    assert not any(preview.find_visible_image(name).partial for name in ports)


def test_frames_that_need_the_ones_before_are_made_whole(preview, engine):
    graph = chain().add("trails", LightTrails()).connect(Port("color", "out"), Port("trails", "image"))
    ports = {"A": Port("trails", "out")}
    request_preview(preview, graph, ports, bindings=BINDINGS)
    settle(preview)
    preview.glimpse = SEEN
    request_preview(preview, graph.set(Port("light", "stops"), 2.0), ports, bindings=BINDINGS)
    while preview.work(0.0):
        assert not preview.find_visible_image("A").partial
        time.sleep(0.0005)
    assert preview.remembers


def test_a_fault_is_found_as_ever(preview, engine):
    request_preview(preview, chain(), bindings=BINDINGS)
    settle(preview)
    preview.glimpse = SEEN
    broken = chain().disconnect(Port("blur", "image"))
    request_preview(preview, broken, bindings=BINDINGS)
    settle(preview)
    assert "blur" in preview.faults and preview.find_whole_image("A") is not None
    request_preview(preview, chain(stops=2.0), bindings=BINDINGS)
    settle(preview)
    assert preview.faults == {}
    np.testing.assert_array_equal(pixels(preview, engine), whole(engine, chain(stops=2.0)))


def test_regions_are_whole_steps_of_a_grid_within_the_picture():
    region = SEEN.region((WIDTH, HEIGHT))
    assert all(part % GRID == 0 for part in (region.x, region.y, *region.size))
    corner = VisibleRegion((0.8, 0.9, 1.0, 1.0), (WIDTH, HEIGHT), SEEN.names).region((WIDTH, HEIGHT))
    assert (corner.across[1], corner.down[1]) == (WIDTH, HEIGHT)
    assert SEEN.region((300, 200)) is None, "of few pixels, all are made at once"
    assert SEEN.share(1.0) == pytest.approx(region.width * region.height / (WIDTH * HEIGHT))

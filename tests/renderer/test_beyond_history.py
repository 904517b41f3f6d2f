"""Nodes that remember, paint, or run on the processor make pixels beyond the frame: those of a larger frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import create_output
from halation.compiler.explain import explain, plan_as_json
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Node, PaintStroke, PaintTool, catalogue, name_paint_strokes
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.renderer.execution import host_jobs
from isf_files import IMAGE, node
from scipy.ndimage import gaussian_filter

NODES = catalogue()
WIDTH, HEIGHT, MARGIN = 64, 48, 12
LARGE = (WIDTH + 2 * MARGIN, HEIGHT + 2 * MARGIN)
FRAMES = (1, 4)


def make_plate(frame: int) -> np.ndarray:
    """A picture with a margin beyond the frame, another one in each frame."""
    rng = np.random.default_rng(frame)
    plate = np.ones((LARGE[1], LARGE[0], 4), np.float32)
    plate[..., :3] = gaussian_filter(rng.random((LARGE[1], LARGE[0], 3)), (1, 1, 0))
    return plate


@pytest.fixture(scope="module")
def plates(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Files of all frames: `beyond` have their margin beyond the frame, `large` within a larger one."""
    folder = tmp_path_factory.mktemp("plates")
    for kind, margin in (("beyond", MARGIN), ("large", 0)):
        for frame in range(FRAMES[0], FRAMES[1] + 1):
            spec = oiio.ImageSpec(*LARGE, 4, "float")
            spec.x = spec.y = -margin
            spec.full_x = spec.full_y = 0
            spec.full_width, spec.full_height = LARGE[0] - 2 * margin, LARGE[1] - 2 * margin
            file = create_output(folder / f"{kind}.{frame:04}.exr")
            assert file.open(str(folder / f"{kind}.{frame:04}.exr"), spec)
            assert file.write_image(make_plate(frame)) and file.close()
    return {kind: str(folder / f"{kind}.####.exr") for kind in ("beyond", "large")}


def make_graph(node: Node, file: str, overscan: float, **constants: tuple[float, ...]) -> Graph:
    """The node on a shot, with constants at its other inputs."""
    graph = Graph(settings=Settings(frames=FRAMES, overscan=overscan)).add_input("picture", Input(file=file))
    graph = graph.add("node", node).connect(Port("inputs", "picture"), Port("node", "image"))
    for name, value in constants.items():
        graph = graph.add(name, NODES["combine_vector4"]())
        for axis, part in zip("xyzw", value, strict=True):
            graph = graph.add(axis, NODES["luminance"]()).add(
                f"{axis}_color", NODES["constant"](color=(part,) * 3 + (1.0,))
            )
            graph = graph.connect(Port(f"{axis}_color", "out"), Port(axis, "image"))
            graph = graph.connect(Port(axis, "out"), Port(name, axis))
        graph = graph.connect(Port(name, "vector"), Port("node", name))
    return graph.add_output("out", Output()).connect(Port("node", "out"), Port("outputs", "out"))


def render_shot(renderer: Renderer, graph: Graph, frames: tuple[int, ...] = (2, 4)) -> list[np.ndarray]:
    """All pixels of frames, also those beyond their frame."""
    request = RenderRequest(precision="float", whole=frozenset({"out"}))
    made = FrameRenderer(renderer, graph, request)
    try:
        return [made.render_frame(frame)["out"].copy() for frame in frames]
    finally:
        made.close()


MEMORIES: Mapping[str, tuple[Node, dict[str, tuple[float, ...]]]] = {
    "frame_blend": (NODES["frame_blend"](time=0.2), {}),
    "light_trails": (NODES["light_trails"](), {}),
    "feedback": (NODES["feedback"](rotation=0.2, scale=1.1, hue=0.3), {}),
    "temporal_aa": (NODES["temporal_aa"](), {"velocity": (1.5, -2.25, 0.0, 0.0)}),
    "temporal_accumulation": (NODES["temporal_accumulation"](), {"velocity": (-2.5, 3.0, 0.0, 0.0)}),
}


@pytest.mark.parametrize("name", MEMORIES)
def test_what_is_remembered_goes_on_beyond_the_frame(renderer: Renderer, plates: dict[str, str], name: str) -> None:
    """All pixels of a frame with an overscan are those of a frame that is as large as both."""
    node, constants = MEMORIES[name]
    made = render_shot(renderer, make_graph(node, plates["beyond"], MARGIN / HEIGHT, **constants))
    expected = render_shot(renderer, make_graph(node, plates["large"], 0.0, **constants))
    for picture, whole in zip(made, expected, strict=True):
        np.testing.assert_allclose(picture, whole, atol=1e-5)


def test_what_left_the_frame_is_still_remembered_when_it_comes_back(renderer: Renderer, plates: dict[str, str]) -> None:
    """A mean of frames between two moves, in closed form; without overscan the moved edge is black."""
    keep = 0.75
    plate = [make_plate(frame)[MARGIN:-MARGIN, MARGIN:-MARGIN].astype(np.float64) for frame in range(1, 5)]
    expected = plate[0]
    for picture in plate[1:]:
        expected = keep * expected + (1.0 - keep) * picture
    for overscan in (0.25, 0.0):
        graph = Graph(settings=Settings(frames=FRAMES, overscan=overscan))
        graph = graph.add_input("picture", Input(file=plates["beyond"]))
        graph = graph.add("away", NODES["transform"](position=(9.0, 7.0), kernel="nearest"))
        graph = graph.add("blend", NODES["frame_blend"](mode="persistence", persistence=keep))
        graph = graph.add("back", NODES["transform"](position=(-9.0, -7.0), kernel="nearest"))
        ports = ("inputs", "picture"), ("away", "out"), ("blend", "out"), ("back", "out")
        graph = graph.add_output("out", Output())
        for source, target in zip(ports, ("away", "blend", "back", "outputs"), strict=True):
            graph = graph.connect(Port(*source), Port(target, "out" if target == "outputs" else "image"))
        frame_renderer = FrameRenderer(renderer, graph, RenderRequest(precision="float"))
        made = frame_renderer.render_frame(4)["out"].copy()
        frame_renderer.close()
        np.testing.assert_allclose(made[:-7, :-9], expected[:-7, :-9], atol=1e-6)
        assert np.allclose(made, expected, atol=1e-6) == (overscan > 0.0)


@pytest.mark.parametrize("overscan", [MARGIN / HEIGHT, 0.125])
def test_a_program_on_the_processor_gets_all_pixels(
    renderer: Renderer, plates: dict[str, str], monkeypatch: pytest.MonkeyPatch, overscan: float
) -> None:
    """A blur in place of the library: pictures of all sizes are as large as the largest."""
    seen: list[tuple[int, ...]] = []

    def blur(pictures: Mapping[str, np.ndarray], settings: object, report: object) -> np.ndarray:
        seen.extend(picture.shape for picture in pictures.values())
        return gaussian_filter(pictures["color"] * pictures["albedo"], (2.0, 2.0, 0.0), mode="nearest")

    monkeypatch.setattr(host_jobs, "HOST_PROGRAMS", {"open_image_denoise": blur})
    graph = make_graph(NODES["denoise"](), plates["beyond"], overscan)
    graph = graph.add("white", NODES["constant"](color=(0.5, 0.25, 1.0, 1.0)))
    graph = graph.connect(Port("white", "out"), Port("node", "albedo"))
    (made,) = render_shot(renderer, graph, (2,))
    margin = int(overscan * HEIGHT)
    plate = make_plate(2)[MARGIN - margin :, MARGIN - margin :][: HEIGHT + 2 * margin, : WIDTH + 2 * margin]
    expected = gaussian_filter(plate[..., :3] * (0.5, 0.25, 1.0), (2.0, 2.0, 0.0), mode="nearest")
    assert set(seen) == {(HEIGHT + 2 * margin, WIDTH + 2 * margin, 4)}
    np.testing.assert_allclose(made[..., :3], expected, atol=1e-5)


def place_strokes(size: tuple[int, int], corner: int) -> Node:
    """Strokes of all tools that cross each side of the frame, whose pixels begin at `corner` of a picture."""
    width, height = size

    def trace(*places: tuple[float, float]) -> tuple[float, ...]:
        return tuple(part for x, y in places for part in ((x + corner) / width, (y + corner) / height, 1.0))

    strokes = {
        "a_brush": PaintStroke(points=trace((-10, 20), (30, -9), (70, 30)), size=7.0 / height, color=(0.9, 0.3, 0.1)),
        "b_clone": PaintStroke(
            tool=PaintTool.CLONE,
            points=trace((50, 40), (72, 55)),
            size=9.0 / height,
            offset=(-20 / width, -30 / height),
        ),
        "c_blur": PaintStroke(
            tool=PaintTool.BLUR, points=trace((-8, 40), (20, 56)), size=12.0 / height, sigma=2.0 / height
        ),
        "d_smear": PaintStroke(tool=PaintTool.SMEAR, points=trace((60, 5), (72, 15)), size=10.0 / height),
    }
    return NODES["paint"](strokes=name_paint_strokes(**strokes))


@pytest.mark.parametrize("output", ["out", "painted"])
def test_paint_goes_on_beyond_the_frame(renderer: Renderer, plates: dict[str, str], output: str) -> None:
    """Strokes beyond the frame, and what they copy from there, are those of a larger frame."""

    def render(node: Node, file: str, overscan: float) -> np.ndarray:
        graph = make_graph(node, file, overscan)
        if output == "painted":
            graph = graph.connect(Port("node", "painted"), Port("outputs", "out"))
        return render_shot(renderer, graph, (2,))[0]

    made = render(place_strokes((WIDTH, HEIGHT), 0), plates["beyond"], MARGIN / HEIGHT)
    expected = render(place_strokes(LARGE, MARGIN), plates["large"], 0.0)
    np.testing.assert_allclose(made, expected, atol=2e-5)


def test_strokes_beyond_a_picture_are_kept(run) -> None:
    """A stroke beside the frame of a picture that ends there: it is moved in."""
    strokes = name_paint_strokes(a=PaintStroke(points=(-0.1, 0.5, 1.0), size=6.0 / HEIGHT, color=(0.2, 0.4, 0.6)))
    graph = Graph(settings=Settings(overscan=0.5)).add_input("picture", Input())
    graph = graph.add("paint", NODES["paint"](strokes=strokes))
    graph = graph.add("move", NODES["transform"](position=(20.0, 0.0), kernel="nearest"))
    graph = graph.connect(Port("inputs", "picture"), Port("paint", "image"))
    graph = graph.connect(Port("paint", "out"), Port("move", "image")).add_output("out", Output())
    made = run(graph.connect(Port("move", "out"), Port("outputs", "out")), {"picture": make_plate(1)[:HEIGHT, :WIDTH]})
    middle = round(-0.1 * WIDTH) + 20
    np.testing.assert_allclose(made[HEIGHT // 2, middle, :3], (0.2, 0.4, 0.6), atol=1e-6)
    assert not made[2, middle].any()


def test_explain_says_where_pictures_begin_and_what_ends_at_the_frame(
    renderer: Renderer, plates: dict[str, str]
) -> None:
    request = RenderRequest(whole=frozenset({"out"}))
    plan = renderer.compile(make_graph(NODES["frame_blend"](), plates["beyond"], MARGIN / HEIGHT), request)
    assert "88x72 from -12,-12 of 64x48" in explain(plan)
    assert "ends at the frame" not in explain(plan)
    surface = plan_as_json(plan)["surfaces"][plan.outputs["out"]]  # type: ignore[index]
    assert (surface["size"], surface["frame"], surface["start"]) == ([88, 72], [64, 48], [-12, -12])
    shader = node("gl_FragColor = IMG_THIS_PIXEL(inputImage);", IMAGE)
    graph = make_graph(NODES["frame_blend"](), plates["beyond"], MARGIN / HEIGHT).add("shader", shader)
    graph = graph.connect(Port("node", "out"), Port("shader", "inputImage")).add_output("framed", Output())
    graph = graph.connect(Port("shader", "out"), Port("outputs", "framed"))
    plan = renderer.compile(graph, request)
    assert "ends at the frame" in explain(plan)
    assert plan.surfaces[plan.outputs["framed"]].window is None and plan.surfaces[plan.outputs["out"]].size == LARGE

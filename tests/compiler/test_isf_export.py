"""Graphs as shaders in the Interactive Shader Format: read back, they make the same pictures."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.compiler.ir import PictureShape, UniformConstant
from halation.compiler.isf import IsfExport, export_isf
from halation.compiler.isf.affine import FittedKnob, find_length_formula, fit_slopes, take_apart
from halation.compiler.isf.controls import find_controls
from halation.custom_nodes import CustomNode
from halation.graph import Control, Graph, Input, Output, Port, Settings
from halation.inputs.lazy_provider import LazyResourceProvider
from halation.nodes import Filter, Image, Kind, Node, Value, catalogue
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given
from hypothesis import strategies as some
from isf_files import Array, graph_of_node, opaque, shader

TARGET = Port("outputs", "out")


def made(name: str, **values: Any) -> Node:
    return catalogue()[name](**values)


def chain(*nodes: Node, pictures: int = 1) -> Graph:
    """Nodes one after the other: n0, n1, ..."""
    graph = Graph(settings=Settings(frames=(1, 9)))
    for number in range(pictures):
        graph = graph.add_input(f"image{number}", Input(Kind.IMAGE, 4))
    graph = graph.add_output("out", Output(Kind.IMAGE, 4))
    last = Port("inputs", "image0") if pictures else None
    for number, one in enumerate(nodes):
        graph = graph.add(f"n{number}", one)
        if last:
            graph = graph.connect(last, Port(f"n{number}", next(iter(one.inputs))))
        last = Port(f"n{number}", next(iter(one.outputs)))
    assert last is not None
    return graph.connect(last, TARGET)


def exported(graph: Graph, size: tuple[int, int] = (64, 48)) -> IsfExport:
    found = export_isf(graph, TARGET, LazyResourceProvider(sandbox=UNRESTRICTED), size=size)
    assert not found.reasons
    return found


def both(
    renderer: Renderer, graph: Graph, text: str, size: tuple[int, int], frame: int = 1, /, **values: Any
) -> tuple[Array, Array]:
    """What the graph makes, and what the shader makes; pictures reach above white."""
    kind: type[CustomNode] = shader(text)
    pictures = {
        name: opaque(size[1], size[0], seed) * np.array([3, 3, 3, 1], np.float32)
        for seed, name in enumerate(graph.inputs)
    }
    wanted = renderer.render(graph, RenderRequest(pictures, size=size, frame=frame, precision="float"))["out"]
    given = dict(zip(kind.inputs, pictures.values(), strict=True))
    item = graph_of_node(kind(**values), size)
    return wanted, renderer.render(item, RenderRequest(given, size=size, frame=frame, precision="float"))["out"]


def close(pair: tuple[Array, Array], far: float = 1e-4) -> bool:
    return pair[0].shape == pair[1].shape and bool(np.abs(pair[0] - pair[1]).max() < far)


GRAPHS = {
    "points": chain(made("exposure", stops=0.5), made("saturation"), made("vignette"), made("hue_saturation")),
    "edges": chain(made("edge_detect"), made("invert")),
    "blur": chain(made("gaussian_blur", sigma=3.0), made("exposure", stops=-1.0)),
    "wide blur": chain(made("gaussian_blur", sigma=20.0)),
    "sharpen": chain(made("sharpen"), made("posterize")),
    "pattern": chain(made("noise"), made("invert"), pictures=0),
    "median": chain(made("median")),
    "warp": chain(made("swirl"), made("bulge")),
}


@pytest.mark.parametrize("name", GRAPHS)
def test_a_shader_makes_what_its_graph_makes(renderer: Renderer, name: str) -> None:
    """At the size that it was made for; and at another one, unless it says that this looks different."""
    graph = GRAPHS[name]
    found = exported(graph)
    assert close(both(renderer, graph, found.text, (64, 48)))
    if not any("looks different" in note for note in found.notes):
        assert close(both(renderer, graph, found.text, (83, 61)))


def test_the_whole_size_is_followed(renderer: Renderer) -> None:
    for name in ("points", "edges", "blur", "warp", "median"):
        assert not exported(GRAPHS[name]).notes


def test_controls_become_inputs(renderer: Renderer) -> None:
    graph = chain(made("exposure"), made("saturation"), made("vignette"), made("invert"))
    for name, target in {"stops": "n0.stops", "color": "n1.saturation", "darker": "n2.amount"}.items():
        if Port.parse(target).socket in graph.nodes[target[:2]].values:
            graph = graph.add_control(name, Control(Port.parse(target), label=name.title()))
    found = exported(graph)
    head = json.loads(found.text[2 : found.text.index("*/")])
    assert [one["NAME"] for one in head["INPUTS"]] == ["inputImage", *graph.controls] and "PASSES" not in head
    for values in ({}, {"stops": 1.5}, {"stops": -2.0, "color": 0.25}):
        changed = graph
        for name, value in values.items():
            changed = changed.set_control(name, value)
        assert close(both(renderer, changed, found.text, (64, 48), **values), 1e-3)


def test_the_default_of_a_place_is_counted_from_below_and_that_of_a_color_is_a_code(renderer: Renderer) -> None:
    """As ISF has them: y goes up, and the colors of a picker are codes of a screen."""
    graph = chain(made("swirl", center=(0.3, 0.2), radius=0.4), made("grade", gain=(0.214041, 0.0, 1.0, 1.0)))
    graph = graph.add_control("middle", Control(Port("n0", "center"))).add_control("dark", Control(Port("n1", "gain")))
    found = exported(graph)
    head = json.loads(found.text[2 : found.text.index("*/")])
    defaults = {one["NAME"]: one.get("DEFAULT") for one in head["INPUTS"]}
    assert defaults["middle"] == pytest.approx([0.3, 0.8])
    assert defaults["dark"] == pytest.approx([0.5, 0.0, 1.0, 1.0], abs=1e-5)
    assert close(both(renderer, graph, found.text, (64, 48)), 1e-3)


@pytest.mark.parametrize("name", ["width", "height", "frame", "canvas"])
def test_a_control_may_have_the_name_of_what_the_shader_follows_anyway(renderer: Renderer, name: str) -> None:
    """The size of the picture and the frame are numbers that a shader follows: they must not be taken for controls."""
    graph = chain(made("exposure"), made("film_grain")).add_control(name, Control(Port("n0", "stops")))
    found = exported(graph)
    assert not found.notes and json.loads(found.text[2 : found.text.index("*/")])["INPUTS"][1]["NAME"] == name
    changed = graph.set_control(name, 1.5)
    assert close(both(renderer, changed, found.text, (83, 61), 3, **{name: 1.5}), 1e-2)


def test_a_control_that_changes_what_is_computed_keeps_its_value(renderer: Renderer) -> None:
    graph = chain(made("gaussian_blur", sigma=2.0)).add_control("size", Control(Port("n0", "sigma")))
    found = exported(graph)
    assert found.notes == ("control 'size' keeps its value: it changes more than numbers",)
    assert close(both(renderer, graph, found.text, (64, 48)))


def test_time_goes_on(renderer: Renderer) -> None:
    graph = chain(made("film_grain"))
    found = exported(graph)
    for frame in (1, 4):
        assert close(both(renderer, graph, found.text, (64, 48), frame), 1e-3)


def test_two_pictures(renderer: Renderer) -> None:
    graph = chain(made("mix_images"), pictures=2)
    names = list(graph.nodes["n0"].inputs)
    graph = graph.connect(Port("inputs", "image1"), Port("n0", names[1]))
    found = exported(graph)
    assert "image0" in found.text and "inputImage" not in found.text
    assert close(both(renderer, graph, found.text, (64, 48)))


def test_what_no_shader_can_do_is_listed_by_node() -> None:
    graph = chain(made("feedback"), made("exposure"))
    assert export_isf(graph, TARGET, LazyResourceProvider(sandbox=UNRESTRICTED)).reasons == (
        ("n0", "remembers the frame before"),
    )


def program(*parts: object) -> Any:
    return SimpleNamespace(ops=(parts,), outputs={})


def number(value: float) -> UniformConstant:
    return UniformConstant(value)


def shape(width: int) -> PictureShape:
    return PictureShape((width, 8), 4, False)


@pytest.mark.parametrize(
    ("lower_at", "resizes", "slopes"),
    [
        (lambda x: program("op", number(3.0 * x + 1.0), number(-x), number(7.0)), False, [3.0, -1.0, 0.0]),
        (lambda x: program("op", number(x * x), number(x), number(0.0)), False, None),
        (lambda x: program("op" if x < 1.5 else "other", number(x), number(x), number(0.0)), False, None),
        (lambda x: program("op", number(x), number(x), *[number(0.0)] * (1 if x < 1.5 else 2)), False, None),
        (lambda x: program("op", number(x), shape(round(16 * x))), False, None),
        (lambda x: program("op", number(x), shape(round(16 * x))), True, [1.0]),
        (lambda x: program("op", number(x), shape(16)), False, [1.0]),
        (lambda x: program("op", number(x)) if x < 1.5 else None, False, None),
    ],
    ids=["lines", "parabola", "operation", "count", "sizes", "sizes that may", "same sizes", "none"],
)
def test_slopes_are_those_of_straight_lines(lower_at: Any, resizes: bool, slopes: list[float] | None) -> None:
    """The numbers of a program as known functions of a knob."""
    knob = FittedKnob("x", "x", 1.0, 1.0, 0.5, resizes=resizes)
    base = take_apart(lower_at(knob.base))
    found = fit_slopes(lambda point: (at := lower_at(point["x"])) and take_apart(at), base, knob)
    assert found == (None if slopes is None else pytest.approx(slopes))


@pytest.mark.parametrize(
    ("value", "low", "high"),
    [
        (Value("v", "float", 0.25, low=-2.0, high=3.0), -2.0, 3.0),
        (Value("v", "float", 0.25, low=-2.0, high=3.0, minimum=0.0, maximum=2.0), 0.0, 2.0),
        (Value("v", "float", 5.0, low=-2.0, high=3.0), -2.0, 5.0),
        (Value("v", "float", -7.0, low=-2.0, high=3.0), -7.0, 3.0),
        (Value("v", "float", 0.25, low=-math.inf, high=3.0), 0.0, 1.0),
        (Value("v", "float", 0.25, low=0.0, high=math.inf), 0.0, 1.0),
        (Value("v", "float", 0.25, low=3.0, high=3.0), 0.0, 1.0),
        (Value("v", "float", 0.25, low=3.0, high=2.0), 0.0, 1.0),
    ],
    ids=["its own", "limits", "above", "below", "no low", "no high", "empty", "turned around"],
)
def test_the_range_of_an_input_is_finite_and_holds_its_value(value: Value, low: float, high: float) -> None:
    """JSON has no infinity, and a slider needs two ends."""
    kind = type("Knobbed", (Filter,), {"image": Image(), "__annotations__": {}})
    kind.values, kind.v = {"v": value}, value.default
    graph = Graph().add("n", kind()).add_control("c", Control(Port("n", "v")))
    ((control,), notes) = find_controls(graph, ())
    assert not notes and (control.entry["MIN"], control.entry["MAX"]) == (low, high)
    json.dumps(control.entry, allow_nan=False)


@given(some.integers(1, 64), some.integers(0, 63), some.lists(some.integers(64, 4000), min_size=4, max_size=4))
def test_lengths_are_found(factor: int, added: int, sides: list[int]) -> None:
    """A formula is right for every sample, or there is none."""
    sides = sorted(set(sides))
    lengths = [(side + min(added, factor - 1)) // factor for side in sides]
    text = find_length_formula(sides, lengths)
    if text is None:
        assert len(sides) < 2 or lengths[-1] == lengths[0] or (lengths[-1] - lengths[0]) < 3
        return
    for side, length in zip(sides, lengths, strict=True):
        assert eval(text.format(float(side)), {"floor": np.floor}) == length

"""Graphs in which pages show a node: complete for every node, with what its inputs are said to get.

Kinds of sockets, the layers of the sample and hand-written lists are the reference; nothing is drawn but one glow.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from halation.errors import ShaderError
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind, Node, Source, catalogue
from halation.presets import sample
from halation.reference.examples import EXAMPLES
from halation.reference.node_page import describe_example, describe_time, find_main_value, list_steps, make_example
from halation.reference.specimen import NODE, name_specimen, sample_graph, show_on_sample
from halation.renderer import Renderer, RenderRequest

NODES = catalogue()
SAMPLE = Path("pictures/sample.exr")
LAYERS = {"depth": "Depth", "ids": "Object Index", "position": "Position", "normal": "Normal", "motion": "Vector"}
"""What is linked from the sample, by the name of the graph's input, and its layer."""


def find_source(graph: Graph, socket: str) -> Port | None:
    return graph.links.get(Port(NODE, socket))


@pytest.mark.parametrize("id", NODES)
def test_no_color_that_it_gets_covers_more_than_all(id: str) -> None:
    graph = show_on_sample(NODES[id], SAMPLE)
    for name, item in graph.nodes.items():
        for value in item.values.values() if name != NODE and isinstance(item, Node) else ():
            if value.type == "color":
                assert 0.0 <= graph.value(Port(name, value.name))[3] <= 1.0, f"{name}.{value.name}"


@pytest.mark.parametrize("id", NODES)
def test_every_input_that_is_needed_has_something_of_its_kind(id: str) -> None:
    kind = NODES[id]
    graph = show_on_sample(kind, SAMPLE)
    assert isinstance(graph.nodes[NODE], kind) and graph.settings.size == (480, 270)
    for name, socket in kind.inputs.items():
        port = find_source(graph, name)
        if port is None:
            assert socket.optional, f"{name} must be linked"
            continue
        if port.node != "inputs":
            source = type(graph.nodes[port.node]).outputs[port.socket].socket
            assert source.kind in (socket.kind, Kind.IMAGE), name
            continue
        given = graph.inputs[port.socket]
        assert given.kind is socket.kind and given.width == socket.channels, name
        if socket.kind is Kind.IMAGE:
            assert (given.file, given.layer) == (str(SAMPLE), "Combined")
        elif given.file:
            assert (given.file, given.layer) == (str(SAMPLE), LAYERS[port.socket])
    cameras = [name for name, socket in kind.inputs.items() if socket.kind is Kind.CAMERA]
    for name in cameras:
        port = find_source(graph, name)
        if port is not None:
            solver = graph.nodes[port.node]
            assert (type(solver).id, solver.path) == ("solve_camera", str(SAMPLE))
    assert (
        list(graph.outputs)
        == [name for name in kind.outputs if not kind.outputs[name].socket.kind.is_planned][
            : 1 if issubclass(kind, Source) else None
        ]
    )
    for name, output in graph.outputs.items():
        socket = kind.outputs[name].socket
        assert (output.kind, output.width) == (socket.kind, socket.channels)
        assert graph.links[Port("outputs", name)] == Port(NODE, name)


def test_what_shows_nothing_alone_is_linked_and_other_optional_inputs_are_not() -> None:
    """A node without a needed input shows nothing as long as a number or its only picture is black."""
    linked, free = set[str](), set[str]()
    for id, kind in NODES.items():
        if not kind.inputs or not all(socket.optional for socket in kind.inputs.values()):
            continue
        graph, pictures = show_on_sample(kind, SAMPLE), [s for s in kind.inputs.values() if s.kind is Kind.IMAGE]
        for name, socket in kind.inputs.items():
            if name == "mask" or socket.kind is Kind.VECTOR:
                continue
            is_black = socket.default == 0.0 or (socket.default == (0.0,) * 4 and pictures == [socket])
            assert (find_source(graph, name) is not None) == is_black, f"{id}.{name}"
            (linked if is_black else free).add(id)
    assert linked and free


@pytest.mark.parametrize("id", NODES)
def test_files_are_those_of_the_sample_for_sources_alone(id: str) -> None:
    kind, paths = NODES[id], [value.name for value in NODES[id].values.values() if value.type == "path"]
    shown = show_on_sample(kind, SAMPLE).nodes[NODE]
    for name in paths:
        assert getattr(shown, name) == (str(SAMPLE) if issubclass(kind, Source) else kind.values[name].default)


def test_the_second_picture_is_a_glow(renderer: Renderer) -> None:
    """Warm light that is strongest at one place, and nothing at all at a distance: it covers nothing there."""
    graph = show_on_sample(NODES["merge"], SAMPLE)
    main, other = (find_source(graph, name) for name in ("image", "a"))
    sockets = [name for name, socket in NODES["merge"].inputs.items() if socket.kind is Kind.IMAGE]
    ramps = [port for name in sockets if (port := find_source(graph, name)) and port.node != "inputs"]
    assert len(ramps) == 1, (main, other)
    alone = Graph(settings=Settings((96, 54))).add("glow", graph.nodes[ramps[0].node]).add_output("image", Output())
    alone = alone.connect(Port("glow", ramps[0].socket), Port("outputs", "image"))
    light = renderer.render(alone, RenderRequest(precision="float"))["image"]
    y, x = np.unravel_index(light[..., 0].argmax(), light.shape[:2])
    assert abs(x - 0.3 * 96) < 2 and abs(y - 0.4 * 54) < 2
    red, green, blue, alpha = light[y, x]
    assert red > green > blue > 0.0 and alpha > 0.9
    down, across = np.mgrid[:54, :96]
    far = np.hypot(across - x, down - y) > 0.47 * 96
    assert far.any() and not light[far].any()


def test_a_picture_alone_is_the_samples_color() -> None:
    graph = sample_graph(SAMPLE)
    (given,) = graph.inputs.values()
    assert (given.kind, given.width, given.file, given.layer) == (Kind.IMAGE, 4, str(SAMPLE), "Combined")
    assert graph.links == {Port("outputs", "image"): Port("inputs", "beauty")}


def test_faults_of_shaders_name_the_type_of_the_node() -> None:
    fault = ShaderError("node", "file.glsl", 7, "is wrong")
    with pytest.raises(ShaderError, match="gaussian_blur") as caught, name_specimen(NODES["gaussian_blur"]):
        raise fault
    assert (caught.value.file, caught.value.line, caught.value.fault) == ("file.glsl", 7, "is wrong")


# --- values of examples ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("id", EXAMPLES)
def test_an_example_has_its_values_and_is_described_by_them(id: str) -> None:
    """Numbers in the sentence are those of the node, to the six digits that are written."""
    kind = NODES[id]
    graph, words = make_example(kind), describe_example(kind)
    assert graph.nodes[NODE] != kind() and show_on_sample(kind, sample()).links == graph.links
    for name, value in EXAMPLES[id].items():
        assert getattr(graph.nodes[NODE], name) == value != kind.values[name].default
        written = re.search(rf"`{name}` at (\([^)]*\)|\d+ items?|[^,]+)", words)
        assert written is not None, words
        if isinstance(value, tuple):
            assert [float(part) for part in written[1].strip("()").split(",")] == pytest.approx(value, rel=1e-5)
        elif isinstance(value, bool):
            assert written[1] == str(value).lower()
        elif isinstance(value, float):
            assert float(written[1]) == pytest.approx(value, rel=1e-5)
        elif isinstance(value, str):
            assert written[1] == value
        else:
            assert written[1] == f"{len(value)} item" + "s" * (len(value) != 1)


@pytest.mark.parametrize("id", EXAMPLES)
def test_values_of_examples_are_within_the_sliders(id: str) -> None:
    """What a page shows can be set by hand."""
    for name, value in EXAMPLES[id].items():
        declared = NODES[id].values[name]
        numbers = value if isinstance(value, tuple) else (value,)
        if declared.type in ("float", "int", "vector", "color") and np.isfinite([declared.low, declared.high]).all():
            assert all(declared.low <= number <= declared.high for number in numbers), name
        if declared.type == "choice":
            assert value in declared.choices
        if declared.type == "curve":
            assert (np.diff(value[::2]) > 0.0).all() and 0.0 <= min(value[::2]) <= max(value[::2]) <= 1.0
            assert declared.low <= min(value[1::2]) <= max(value[1::2]) <= declared.high


def test_what_is_not_changed_is_not_described() -> None:
    kind = NODES["gaussian_blur"]
    assert describe_example(kind) == "" and make_example(kind).nodes[NODE] == kind()


@pytest.mark.parametrize("id", NODES)
def test_steps_go_from_end_to_end_of_a_slider(id: str) -> None:
    """Five of them, with equal distances, or with equal ratios over two powers of ten."""
    value = find_main_value(NODES[id])
    if value is None:
        declared = NODES[id].values.values()
        assert not [v for v in declared if v.type in ("float", "int") and not v.folded and np.isfinite(v.high - v.low)]
        return
    steps = list_steps(value)
    assert len(steps) == 5 and steps[0] == pytest.approx(value.low, rel=6e-3) and value.type in ("float", "int")
    assert steps[-1] == pytest.approx(value.high, rel=6e-3)
    has_ratios = value.low > 0.0 and value.high / value.low >= 100.0
    places = np.log(steps) if has_ratios else np.array(steps)
    error = 0.01 if has_ratios else 6e-3 * max(map(abs, steps)) + 0.5 * (value.type == "int")
    np.testing.assert_allclose(
        places, np.linspace(places[0], places[-1], 5), atol=error + 0.5 * has_ratios * (value.type == "int")
    )


@pytest.mark.parametrize(("seconds", "words"), [(0.0123, "12 ms"), (0.0100, "10 ms"), (0.00994, "9.9 ms"),
                                                (0.00012, "0.12 ms"), (1.5, "1500 ms")])  # fmt: skip
def test_times_have_two_digits(seconds: float, words: str) -> None:
    assert describe_time(seconds, "a GPU") == f"It takes {words} with a GPU."

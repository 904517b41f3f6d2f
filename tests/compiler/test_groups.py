"""Groups, muting, and what is said of graphs that go in circles."""

from __future__ import annotations

import pytest
from halation.compiler.lowering.expand import make_zero
from halation.errors import GraphError, UsageError
from halation.graph import Control, Graph, Group, Input, Output, Port, Settings, Unknown
from halation.nodes import Field, Image, Kind, Vector, catalogue
from halation.nodes.color.exposure import Exposure
from halation.nodes.input.checker import Checker
from headers import Headers

NODES = catalogue()
IMAGE = {"image": Input(Kind.IMAGE)}
SETTINGS = Settings((8, 6))
SIZE = (37, 23)
"""Of the pictures of all inputs: see the fixture `plan`."""


def graph(nodes, links: dict[str, str], inputs=IMAGE, outputs=None, **rest) -> Graph:
    """A graph as a file may hold it: nothing is checked."""
    ports = {Port.parse(target): Port.parse(source) for target, source in links.items()}
    return Graph(nodes=nodes, links=ports, inputs=inputs, outputs=outputs or {"image": Output()}, **rest)


PASSING = graph({}, {"outputs.image": "inputs.image"})
GENERATOR = graph(
    {"c": Checker()},
    {"outputs.image": "c.out", "outputs.mask": "c.value"},
    {},
    {"image": Output(), "mask": Output(Kind.FIELD)},
)


def key(plan, made: Graph, **options) -> str:
    planned = plan(made, **options)
    return planned.surfaces[next(iter(planned.outputs.values()))].key


def light(stops: float) -> Graph:
    return graph({"a": Exposure(stops=stops)}, {"a.image": "inputs.image", "outputs.image": "a.out"})


def test_an_input_may_be_linked_straight_to_an_output(plan):
    wrapped = graph({"g": Group(PASSING)}, {"g.image": "inputs.image", "outputs.image": "g.image"})
    assert key(plan, wrapped) == key(plan, PASSING)


@pytest.mark.parametrize(
    "links",
    [
        {"g.image": "g.image", "outputs.image": "g.image"},
        {"g.image": "h.image", "h.image": "g.image", "outputs.image": "g.image"},
    ],
    ids=["itself", "two"],
)
def test_groups_that_feed_themselves_are_an_error(plan, links):
    with pytest.raises(GraphError, match=r"group '[gh]' feeds itself"):
        plan(graph({"g": Group(PASSING), "h": Group(PASSING)}, links))


def test_a_group_output_can_be_asked_for(plan):
    wrapped = graph({"g": Group(light(1.0))}, {"g.image": "inputs.image", "outputs.image": "inputs.image"})
    assert key(plan, wrapped, targets={"x": Port("g", "image")}) == key(plan, light(1.0))


def test_two_instances_have_values_of_their_own(plan):
    body = light(0.5).add_control("light", Control(Port("a", "stops")))
    two = graph(
        {"g": Group(body, values={"light": 1.0}), "h": Group(body, values={"light": 2.0})},
        {"g.image": "inputs.image", "h.image": "g.image", "outputs.image": "h.image"},
    )
    flat = graph(
        {"a": Exposure(stops=1.0), "b": Exposure(stops=2.0)},
        {"a.image": "inputs.image", "b.image": "a.out", "outputs.image": "b.out"},
    )
    assert key(plan, two) == key(plan, flat)


def test_a_control_of_a_control_can_be_wired_from_outside(plan):
    inner = light(0.5).add_control("light", Control(Port("a", "stops")))
    outer = graph({"inner": Group(inner)}, {"inner.image": "inputs.image", "outputs.image": "inner.image"})
    outer = outer.add_control("glow", Control(Port("inner", "light")))
    inputs = {**IMAGE, "by": Input(Kind.FIELD)}
    links = {"g.image": "inputs.image", "g.glow": "inputs.by", "outputs.image": "g.image"}
    by_field = {"a.image": "inputs.image", "a.stops": "inputs.by", "outputs.image": "a.out"}
    flat = graph({"a": Exposure()}, by_field, inputs)
    assert key(plan, graph({"g": Group(outer)}, links, inputs)) == key(plan, flat)


@pytest.mark.parametrize("grouped", [False, True])
def test_a_link_that_does_not_fit_is_refused_where_it_is_needed(plan, grouped):
    """A file may hold any link; the red channel would quietly stand for a mask."""
    links = {"m.a": "inputs.image", "m.b": "inputs.image", "m.mask": "inputs.image", "outputs.image": "m.out"}
    made = graph({"m": NODES["merge"]()}, links)
    if grouped:
        made = graph({"g": Group(made)}, {"g.image": "inputs.image", "outputs.image": "g.image"})
    with pytest.raises(GraphError, match=r"'inputs.image' cannot feed 'm.mask': an Image does not fit a Field"):
        plan(made)
    assert plan(made, targets={"x": Port("inputs", "image")}).passes == ()


def test_an_output_that_nothing_feeds_inside_is_named(plan):
    with pytest.raises(GraphError, match="group 'g': nothing inside it is linked to its output 'image'"):
        plan(graph({"g": Group(graph({}, {}))}, {"g.image": "inputs.image", "outputs.image": "g.image"}))


def test_an_unknown_output_is_named(plan):
    with pytest.raises(GraphError, match="no output 'imgae'; did you mean 'image'"):
        plan(PASSING, targets={"x": Port("outputs", "imgae")})


def test_an_unknown_node_is_an_error_only_where_it_is_needed(plan):
    beside = graph(
        {"u": Unknown("lens"), "a": Exposure(stops=1.0)},
        {"a.image": "inputs.image", "u.image": "a.out", "outputs.image": "a.out"},
    )
    assert key(plan, beside) == key(plan, light(1.0))
    with pytest.raises(GraphError, match="node 'u' has the unknown type 'lens'"):
        plan(beside, targets={"x": Port("u", "out")})


@pytest.mark.parametrize("name", sorted(NODES))
def test_muted_outputs_keep_their_type(plan, name):
    """An input of the same type, else one that fits, else nothing. Cameras and single values are no pictures."""
    node = NODES[name]
    drawn = {key: made for key, made in node.outputs.items() if made.socket.kind is not Kind.CAMERA}
    ends = {key: Output(made.socket.kind, made.socket.channels) for key, made in drawn.items()}
    inputs = {
        key: Input(socket.kind, socket.channels, default=(0.0,) * socket.channels if socket.single else None)
        for key, socket in node.inputs.items()
    }
    if not ends:
        return
    links = {f"n.{key}": f"inputs.{key}" for key in inputs} | {f"outputs.{key}": f"n.{key}" for key in ends}
    made = plan(graph({"n": node()}, links, inputs, ends, settings=SETTINGS, muted=frozenset({"n"})))
    for key, output in drawn.items():
        surface = made.surfaces[made.outputs[key]]
        assert surface.channels == output.socket.channels
        assert output.socket.single == (surface.size == (1, 1))
        same = [made for made in node.inputs.values() if made.kind is output.socket.kind and not made.single]
        keeps_size = node().output_size(dict.fromkeys(inputs, SIZE), SIZE) == SIZE
        if keeps_size and any(socket.channels == output.socket.channels for socket in same):
            assert made.outputs[key] in {upload.surface for upload in made.uploads}


def test_a_muted_group_that_makes_pictures_makes_none(plan):
    muted = graph(
        {"g": Group(GENERATOR)},
        {"outputs.image": "g.image", "outputs.mask": "g.mask"},
        {},
        {"image": Output(), "mask": Output(Kind.FIELD)},
        settings=SETTINGS,
        muted=frozenset({"g"}),
    )
    made = plan(muted)
    assert "checker" not in {name for one in made.passes for name in one.functions}
    assert {made.surfaces[number].channels for number in made.outputs.values()} == {4, 1}


def test_nothing_is_zero_in_every_channel():
    for socket, zero in ((Field(), 0.0), (Vector(width=3), (0.0, 0.0, 0.0)), (Image(), (0.0, 0.0, 0.0, 0.0))):
        assert make_zero(socket) == zero


def test_inside_a_muted_group_nothing_matters(plan):
    broken = graph({"u": Unknown("lens")}, {"u.image": "inputs.image", "outputs.image": "u.out"})
    muted = graph({"g": Group(broken)}, {"g.image": "inputs.image", "outputs.image": "g.image"}, muted=frozenset({"g"}))
    assert key(plan, muted) == key(plan, PASSING)


@pytest.mark.parametrize(
    "options",
    [
        {"scale": 0.0},
        {"scale": -1.0},
        {"scale": float("nan")},
        {"scale": float("inf")},
        {"size": (0, 4)},
        {"size": (4, -1)},
    ],
)
def test_sizes_of_nothing_are_refused(plan, options):
    with pytest.raises(UsageError, match="give"):
        plan(PASSING, **options)


@pytest.mark.parametrize("stops", [float("nan"), float("inf"), 1e39])
def test_values_that_no_shader_takes_are_named(plan, stops):
    with pytest.raises(GraphError, match=r"a\.stops: "):
        plan(light(stops))


@pytest.mark.parametrize("default", [float("nan"), (1.0, 0.0, 0.0), "red"])
def test_a_default_that_does_not_fit_is_named(plan, default):
    inputs = {"image": Input(Kind.COLOR, default=default)}
    with pytest.raises(GraphError, match=r"input 'image': the default .* does not fit Color"):
        plan_without_bindings(light(1.0), inputs)


def plan_without_bindings(made: Graph, inputs):
    from dataclasses import replace

    from halation.compiler import Request, compile_graph

    return compile_graph(replace(made, inputs=inputs, settings=SETTINGS), Request(), Headers((8, 6)))


def test_zeros_of_both_signs_are_one(plan):
    """They compare equal, so an operation with one must not stand for the other."""
    assert key(plan, _scaled(0.0)) == key(plan, _scaled(-0.0))


def _scaled(by: float) -> Graph:
    inputs = {"f": Input(Kind.FIELD)}
    node = NODES["math"](operation="multiply", b=by)
    return graph({"m": node}, {"m.a": "inputs.f", "outputs.image": "m.out"}, inputs, {"image": Output(Kind.FIELD)})


def test_a_pass_keeps_within_the_uniforms_that_every_device_has(plan):
    grade = NODES["grade"](gain=(1.01, 1.0, 1.0, 1.0))
    nodes = {f"n{number:02}": grade for number in range(60)}
    links = {f"n{number:02}.image": f"n{number - 1:02}.out" for number in range(1, 60)}
    made = plan(graph(nodes, {**links, "n00.image": "inputs.image", "outputs.image": "n59.out"}))
    for one in made.passes:
        assert sum(12 if isinstance(value, tuple) and len(value) == 9 else 4 for _, value in one.uniforms) <= 512 + 16


def test_too_many_or_an_even_number_of_weights_is_an_error(plan):
    from halation.compiler import Library, load_library
    from halation.compiler.library import parse
    from halation.errors import ShaderError
    from halation.nodes import Draw, Drawn, Filter, Image

    def weighted(count: int) -> Graph:
        class Wide(Filter):
            """A long convolution."""

            image = Image()

            def passes(self, draw: Draw) -> Drawn:
                return draw.convolve(self.image, (1.0 / count,) * count, "x")

        return graph({"w": Wide()}, {"w.image": "inputs.image", "outputs.image": "w.out"})

    texts = Library({**load_library().texts, "compiler/wide": parse("compiler/wide", "")})
    assert len(plan(weighted(4081), library=texts).passes[0].weights) <= 4096
    for count in (2, 4083, 100_001):
        with pytest.raises(ShaderError, match="an odd number of weights up to 4081"):
            plan(weighted(count), library=texts)


@pytest.mark.parametrize("limits", [{"form": "fragment", "max_targets": 1}, {"form": "compute", "max_images": 1}])
def test_more_outputs_than_the_device_writes_at_once_is_an_error(plan, limits):
    from dataclasses import replace

    from halation.compiler import NULL
    from halation.errors import DeviceError
    from msgspec import structs

    with pytest.raises(DeviceError, match=r"node 'c': a device writes 1 of its outputs at once, not 2"):
        plan(replace(GENERATOR, settings=SETTINGS), target=structs.replace(NULL, **limits))

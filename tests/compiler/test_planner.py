"""What is planned by what is known of the plans before is what is planned from the start."""

from __future__ import annotations

import dataclasses
import gc
import weakref
from random import Random

import numpy as np
import pytest
from edited_graphs import edit_randomly, make_graph
from halation.compiler import NULL, Planner, Region, Request, compile_graph
from halation.compiler import planner as planning
from halation.compiler.fusion.fuse import fuse
from halation.compiler.fusion.rewrites import rewrite_passes
from halation.compiler.lowering.lower import lower
from halation.compiler.planner import MAX_REMEMBERED_PLANS, graph_library
from halation.compiler.scheduling.differences import find_changed_numbers
from halation.errors import GraphError, HalationError
from halation.graph import Control, Expression, Graph, Group, Input, Key, Keys, Output, Port, signature
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from halation.nodes.merge.mix_images import MixImages
from halation.resources.picture import Picture
from halation.resources.provider import PictureProbe
from halation.resources.sandbox import UNRESTRICTED
from headers import Headers
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec import structs
from random_graphs import random_graph

SIZE = (37, 23)


def asked(graph: Graph, frame: int = 1, memories=None, region: Region | None = None) -> Request:
    """A request with every input bound, but single values with a default."""
    bindings = {
        name: Picture(name, "", item.kind, item.socket().channels, in_memory=True)
        for name, item in graph.inputs.items()
        if item.default is None or not item.socket().single
    }
    return Request(bindings=bindings, frame=frame, memories=memories or {}, region=region)


def outcome(plan, graph: Graph, frame: int, memories, region: Region | None = None):
    """A plan with all that it says, or what is wrong."""
    try:
        made = plan(graph, asked(graph, frame, memories, region), Headers(SIZE))
    except HalationError as error:
        return type(error), f"{error}", error.node
    return made, repr(made)


def turned(rng: Random, graph: Graph) -> Graph:
    """A graph where some value, in groups too, is another one: often one where something begins or ends."""
    id = rng.choice([*graph.nodes])
    item, values = graph.nodes[id], signature(graph.nodes[id]).values
    if isinstance(item, Group) and rng.random() < 0.5:
        inner = dataclasses.replace(item, graph=turned(rng, item.graph))
        return dataclasses.replace(graph, nodes={**graph.nodes, id: inner})
    value = values[rng.choice([*values])] if values else None
    if value is None:
        return graph
    low, high = max(value.low, value.minimum, -9.0), min(value.high, value.maximum, 9.0)
    if value.type == "choice":
        plain = rng.choice(value.choices)
    elif value.type == "bool":
        plain = rng.random() < 0.5
    elif value.type in ("float", "int"):
        number = rng.choice([0.0, -0.0, value.default, low, high, rng.uniform(low, max(low, high))])
        number = min(max(number, value.minimum), value.maximum)
        plain = int(number) if value.type == "int" else float(number)
    elif value.type in ("color", "vector"):
        plain = tuple(rng.uniform(low, max(low, high)) for _ in value.default)
    else:
        return graph
    return graph.put(Port(id, value.name), plain)


@settings(max_examples=40)
@given(st.integers(0, 2**20))
def test_it_is_the_plan_that_is_made_from_the_start(seed):
    """Of the whole picture, and of a region."""
    rng = Random(seed)
    graph = make_graph(seed) if seed % 3 == 0 else random_graph(seed, rng.randint(3, 12))
    planner, frame, memories, region = Planner(), 1, {}, None
    for _ in range(6):
        plain = outcome(compile_graph, graph, frame, memories, region)
        assert outcome(planner.plan, graph, frame, memories, region) == plain
        if rng.random() < 0.4:
            region = rng.choice([None, Region(3, 4, 9, 7), Region(21, 9, 12, 14)])
        if rng.random() < 0.4:
            frame, memories = frame + 1, getattr(plain[0], "memories", {})
        for _ in range(rng.choice([0, 1, 1, 2])):
            graph = turned(rng, graph) if rng.random() < 0.8 else edit_randomly(rng, graph)


@settings(max_examples=60)
@given(st.integers(0, 2**20))
def test_numbers_decide_nothing_about_passes(seed):
    graph = random_graph(seed, 12)
    library = graph_library(graph, Headers(SIZE))
    program = lower(graph, asked(graph), library, Headers(SIZE)).program
    blank = structs.replace(program, ops=tuple(op.without_numbers() for op in program.ops))
    passes = fuse(program, NULL)
    assert fuse(blank, NULL) == passes
    assert rewrite_passes(blank, passes, NULL, library) == rewrite_passes(program, passes, NULL, library)


def lowered(graph: Graph):
    return lower(graph, asked(graph), graph_library(graph, Headers(SIZE)), Headers(SIZE)).program


def test_programs_that_differ_in_numbers_alone():
    """Another number is found at its operation; whatever else differs, the passes must be planned anew."""
    graph = chain(GaussianBlur(sigma=3.0), Exposure(stops=1.0), GaussianBlur(sigma=5.0))
    program, other = lowered(graph), lowered(graph.put(Port("b", "stops"), 2.0))
    changed = {index for index, (a, b) in enumerate(zip(program.ops, other.ops, strict=True)) if a != b}
    assert changed and find_changed_numbers(program, other) == changed
    assert find_changed_numbers(program, program) == set()
    (output,) = program.outputs.values()
    for fields in (
        {"outputs": {**program.outputs, "second": output}},
        {"memories": {"b": output}},
        {"scale": 0.5},
        {"results": {}},
        {"ops": program.ops[:-1]},
        {"ops": (*program.ops, program.ops[0])},
    ):
        assert getattr(program, next(iter(fields))) != next(iter(fields.values()))
        assert find_changed_numbers(program, structs.replace(program, **fields)) is None, fields
    moved = tuple(structs.replace(op, owner="other") if n in changed else op for n, op in enumerate(other.ops))
    assert find_changed_numbers(program, structs.replace(other, ops=moved)) is None


# --- what is not done again ------------------------------------------------------------------------------------------


@pytest.fixture
def again(monkeypatch):
    """`again(planner, graph, ...)` plans as `from the start`, but may lower nothing as a whole, nor fuse."""

    def planned(planner: Planner, graph: Graph, frame: int = 1, memories=None):
        plain = outcome(compile_graph, graph, frame, memories)
        with monkeypatch.context() as patch:
            for name in ("lower", "fuse"):
                patch.delattr(planning, name)
            assert outcome(planner.plan, graph, frame, memories) == plain
        return plain[0]

    return planned


def chain(*nodes, **inputs: Input) -> Graph:
    """Nodes a, b, ... one after the other."""
    graph, source = Graph(inputs={"image": Input(), **inputs}), Port("inputs", "image")
    for name, node in zip("abcdefgh", nodes, strict=False):
        graph = graph.add(name, node).connect(source, Port(name, "image"))
        source = Port(name, "out")
    return graph.add_output("out", Output(Kind.IMAGE)).connect(source, Port("outputs", "out"))


def first(graph: Graph) -> tuple[Planner, object]:
    planner = Planner()
    return planner, planner.plan(graph, asked(graph), Headers(SIZE))


def test_a_value_changes_no_shader_and_only_what_comes_after_it(again):
    graph = chain(GaussianBlur(sigma=3.0), Exposure(stops=1.0), GaussianBlur(sigma=5.0), Saturation(saturation=0.5))
    planner, before = first(graph)
    after = again(planner, graph.put(Port("b", "stops"), 2.0))
    assert [one.shader for one in after.passes] == [one.shader for one in before.passes]
    same = [one.key == two.key for one, two in zip(before.surfaces, after.surfaces, strict=True)]
    upstream = [surface.label in ("inputs.image", "a") for surface in before.surfaces]
    assert same == upstream


def test_a_blur_may_have_other_weights(again):
    graph = chain(GaussianBlur(sigma=3.0), Exposure(stops=1.0))
    planner, _ = first(graph)
    for sigma in (3.4, 4.0, 2.0):
        again(planner, graph.put(Port("a", "sigma"), sigma))


def test_a_control_of_a_group_is_turned(again):
    body = chain(GaussianBlur(sigma=3.0), Exposure(stops=1.0)).add_control("gain", Control(Port("b", "stops")))
    graph = Graph(inputs={"image": Input()}).add("group", Group(body, values={"gain": 0.5}))
    graph = graph.connect(Port("inputs", "image"), Port("group", "image")).add_output("out", Output(Kind.IMAGE))
    graph = graph.connect(Port("group", "out"), Port("outputs", "out"))
    again(first(graph)[0], graph.put(Port("group", "gain"), 2.0))


def test_frames_of_what_moves_are_planned_in_turn(again):
    graph = chain(Exposure(stops=1.0), GaussianBlur(sigma=3.0), Saturation(saturation=0.5))
    graph = graph.animate(Port("a", "stops"), Expression("0.1 * frame"))
    graph = graph.animate(Port("b", "sigma"), Keys((Key(1.0, 3.0), Key(9.0, 4.0))))
    planner, _ = first(graph)
    for frame in (2, 3, 9, 1):
        again(planner, graph, frame)


def test_whether_all_needs_tiles_is_not_learned_from_a_part():
    """A part that fits on the device says nothing of the picture, and the picture nothing of other values."""
    graph, planner = chain(GaussianBlur(sigma=3.0), Exposure(stops=1.0)), Planner()
    large, part = Headers((40000, 23)), Region(8, 4, 16, 8)
    for step, (region, is_tiled) in enumerate(((part, False), (None, True), (part, False), (None, True), (None, True))):
        other = graph.put(Port("b", "stops"), 0.5 * step)
        made = planner.plan(other, asked(other, region=region), large)
        assert (made.tiling is not None) is is_tiled, step
        assert repr(made) == repr(compile_graph(other, asked(other, region=region), large)), step


def test_equal_nodes_part_and_meet():
    graph = Graph(inputs={"image": Input()}).add("a", Exposure(stops=1.0)).add("b", Exposure(stops=2.0))
    graph = graph.add("mix", MixImages()).add_output("out", Output(Kind.IMAGE))
    for name, socket in zip("ab", MixImages.inputs, strict=False):
        graph = graph.connect(Port("inputs", "image"), Port(name, "image"))
        graph = graph.connect(Port(name, "out"), Port("mix", socket))
    graph = graph.connect(Port("mix", "out"), Port("outputs", "out"))
    planner, _ = first(graph)
    for stops in (1.0, 2.0, 1.0, -0.0, 0.0, 1.0, 2.0):
        other = graph.put(Port("b", "stops"), stops)
        assert outcome(planner.plan, other, 1, {}) == outcome(compile_graph, other, 1, {})


# --- the world beyond ------------------------------------------------------------------------------------------------


class World(Headers):
    """Files that change."""

    def __init__(self) -> None:
        super().__init__(SIZE)
        self.version = 1

    def probe_picture(self, picture: Picture) -> PictureProbe:
        return PictureProbe(self.size, False, f"{picture.path} {self.version}")


def test_files_are_looked_at_every_time():
    graph, world, planner = chain(Exposure(stops=1.0), image=Input(file="a.exr")), World(), Planner()
    keys = set[str]()
    for world.version, world.size in ((1, SIZE), (2, SIZE), (3, (64, 32))):
        plan = planner.plan(graph, Request(), world)
        assert plan == compile_graph(graph, Request(), world)
        keys |= {surface.key for surface in plan.surfaces}
        assert plan.surfaces[plan.outputs["out"]].size == world.size
    assert len(keys) == 6


def test_a_fault_is_said_and_forgotten():
    graph = chain(Exposure(stops=1.0), GaussianBlur(sigma=3.0))
    planner, before = first(graph)
    with pytest.raises(GraphError, match="not linked"):
        broken = graph.disconnect(Port("b", "image"))
        planner.plan(broken, asked(broken), Headers(SIZE))
    assert planner.plan(graph, asked(graph), Headers(SIZE)) == before


def test_pixels_are_not_held_on_to():
    graph, planner, pictures = (
        chain(Exposure(stops=1.0), GaussianBlur(sigma=3.0)),
        Planner(),
        MediaProvider(sandbox=UNRESTRICTED),
    )
    array = np.zeros((*SIZE, 4), np.float32)
    plan = planner.plan(graph, Request(bindings=pictures.bind(graph, {"image": array})), pictures)
    assert plan.uploads[0].picture.pixels is array
    other = array + 1.0
    after = planner.plan(graph, Request(bindings=pictures.bind(graph, {"image": other})), pictures)
    assert after.uploads[0].picture.pixels is other
    gone = [weakref.ref(array), weakref.ref(other)]
    del array, other, plan, after
    gc.collect()
    assert [one() for one in gone] == [None, None]


def test_only_a_few_plans_are_known():
    planner, graphs = Planner(), [chain(*[Exposure(stops=1.0)] * count) for count in range(1, 8)]
    for graph in graphs:
        planner.plan(graph, asked(graph), Headers(SIZE))
    assert len(planner._records) == MAX_REMEMBERED_PLANS


def test_what_a_plan_followed_is_forgotten():
    graph, planner = chain(Exposure(stops=1.0), GaussianBlur(sigma=3.0)), Planner()
    seen = []
    for stops in range(6):
        planner.plan(graph.put(Port("a", "stops"), stops + 1.0), asked(graph), Headers(SIZE))
        (known,) = planner._records
        seen += [weakref.ref(part) for part in (known.lowered, known.lowered.frames, known.lowered.builder)]
    del known
    gc.collect()
    assert [one() is not None for one in seen] == [False] * 15 + [True] * 3

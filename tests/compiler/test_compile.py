"""What the compiler makes of particular graphs."""

from __future__ import annotations

import re
from typing import get_args

import pytest
from halation.compiler import NULL, explain, write_dot
from halation.compiler.ir import Builder, Convolve, PictureShape, Reduce, Ref
from halation.errors import GraphError
from halation.graph import Control, Graph, Group, Input, Output, Port, Settings
from halation.nodes import Edge, Kind, catalogue
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.nodes.color.saturation import Saturation
from halation.nodes.input.checker import Checker
from msgspec.structs import replace

Noise, Displace, Statistics = (catalogue()[name] for name in ("noise", "displace", "luminance_statistics"))


def chain(*nodes) -> Graph:
    """image -> a -> b -> ... -> image."""
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    last = Port("inputs", "image")
    for name, node in zip("abcdefgh", nodes, strict=False):
        graph = graph.add(name, node).connect(last, Port(name, "image"))
        last = Port(name, "out")
    return graph.connect(last, Port("outputs", "image"))


def functions(plan):
    return [one.functions for one in plan.passes]


def test_pointwise_neighbors_share_a_pass(plan):
    graph = chain(Exposure(stops=1.0), Saturation(saturation=0.5), Exposure(stops=-1.0))
    assert functions(plan(graph)) == [("exposure", "saturation", "exposure")]
    assert len(plan(graph, fusion=False).passes) == 3


def test_a_filter_ends_a_pass_and_what_follows_starts_one(plan):
    graph = chain(Exposure(stops=1.0), GaussianBlur(sigma=2.0), Exposure(stops=-1.0))
    assert functions(plan(graph)) == [("exposure",), ("convolve x",), ("convolve y",), ("exposure",)]


def test_decimations_share_a_program_that_is_compiled_for_the_first(plan):
    """Only where all of them are small, their taps stay in a loop, which compiles faster."""
    graph = Graph().add("noise", Noise()).add("blur", GaussianBlur(sigma=50.0)).add_output("image", Output())
    graph = graph.connect(Port("noise", "out"), Port("blur", "image")).connect(
        Port("blur", "out"), Port("outputs", "image")
    )
    programs = dict[tuple[int, int], list[str]]()
    for size in ((1280, 720), (320, 200)):
        made = plan(graph, size=size, target=replace(NULL, form="compute"))
        programs[size] = [one.shader.source for one in made.passes if one.functions[0].startswith("decimate")]
    for size, (first, *others) in programs.items():
        assert len(others) == 3, size
        assert set(others) == {first}, size
        assert ("for (" in first) == (size == (320, 200))


def test_what_enlarges_a_blur_again_looks_for_no_holes(plan):
    made = plan(chain(GaussianBlur(sigma=50.0)), target=replace(NULL, form="compute"))
    tested = {one.functions[0]: "(c) ? vec4(0.0) : c" in one.shader.source for one in made.passes}
    convolutions = {f"{name} {axis}": True for name in ("decimate", "convolve") for axis in "xy"}
    assert tested == {**convolutions, "enlarge": False}


def test_a_picture_of_one_pixel_goes_on_alike_in_all_ways_but_into_black():
    builder, shapes = Builder(), (PictureShape((1, 1), 4, False), PictureShape((2, 1), 4, False))
    dot, row = (builder.add(Reduce((shape,), "n", Ref(0), "sum")) for shape in shapes)

    def blur(picture: Ref, edge: Edge) -> Ref:
        return builder.add(Convolve((shapes[1],), "n", picture, 0, (0.5, 0.5), 1, 0, edge))

    edges = frozenset[Edge](get_args(Edge))
    assert len({blur(dot, edge) for edge in edges - {"black"}}) == 1
    assert blur(dot, "black") not in {blur(dot, edge) for edge in edges - {"black"}}
    assert len({blur(row, edge) for edge in edges}) == len(edges) > 4


def test_what_is_wanted_in_between_is_written_on_the_way(plan):
    graph = chain(Exposure(stops=1.0), Saturation(saturation=0.5))
    graph = graph.add_output("early", Output()).connect(Port("a", "out"), Port("outputs", "early"))
    made = plan(graph)
    assert functions(made) == [("exposure", "saturation")]
    assert sorted(made.passes[0].targets) == sorted(made.outputs.values())


def test_neutral_and_muted_nodes_vanish(plan):
    neutral = chain(Exposure(stops=0.0), Saturation(saturation=0.5))
    muted = chain(Exposure(stops=3.0), Saturation(saturation=0.5)).mute("a", True)
    alone = chain(Saturation(saturation=0.5))
    keys = {made.surfaces[made.outputs["image"]].key for made in map(plan, (neutral, muted, alone))}
    assert len(keys) == 1


def test_what_nothing_needs_is_not_computed(plan):
    graph = chain(Exposure(stops=1.0)).add("idle", Saturation()).connect(Port("a", "out"), Port("idle", "image"))
    assert functions(plan(graph)) == [("exposure",)]


def test_equal_branches_are_computed_once(plan):
    graph = chain(GaussianBlur(sigma=2.0))
    graph = graph.add("twin", GaussianBlur(sigma=2.0)).connect(Port("inputs", "image"), Port("twin", "image"))
    graph = graph.add_output("twin", Output()).connect(Port("twin", "out"), Port("outputs", "twin"))
    made = plan(graph)
    assert len(made.passes) == 2
    assert made.outputs["image"] == made.outputs["twin"]


def test_a_value_changes_the_key_but_not_the_program(plan):
    one, other = plan(chain(Exposure(stops=1.0))), plan(chain(Exposure(stops=2.0)))
    assert one.passes[0].shader == other.passes[0].shader
    assert one.surfaces[-1].key != other.surfaces[-1].key


def test_lengths_in_pixels_shrink_with_a_proxy(plan):
    full = plan(_checker(8.0))
    half = plan(_checker(16.0), scale=0.5, size=(74, 46))
    assert full.passes[0].uniforms[0] == half.passes[0].uniforms[0]


def _checker(size: float) -> Graph:
    graph = Graph(outputs={"image": Output()}, settings=Settings((37, 23))).add("a", Checker(size=size))
    return graph.connect(Port("a", "out"), Port("outputs", "image"))


def test_what_is_made_from_nothing_has_the_size_of_the_first_picture(plan):
    graph = chain(Displace()).add("noise", Noise()).connect(Port("noise", "vector"), Port("a", "vector"))
    made = plan(graph)
    assert {item.size for item in made.surfaces} == {(37, 23)}
    resized = plan(graph, size=(64, 32))
    assert {item.size for item in resized.surfaces} == {(37, 23), (64, 32)}
    assert resized.surfaces[resized.outputs["image"]].size == (64, 32)
    alone = plan(chain(Exposure(stops=1.0)), size=(64, 32))
    assert alone.surfaces[alone.outputs["image"]].size == (64, 32)


def test_a_measured_number_drives_a_value_without_leaving_the_device(plan):
    graph = chain(Exposure()).add("measure", Statistics()).connect(Port("inputs", "image"), Port("measure", "image"))
    made = plan(graph.connect(Port("measure", "average"), Port("a", "stops")))
    last = made.passes[-1]
    assert last.functions == ("exposure",)
    assert sorted(made.surfaces[number].size for number in last.textures) == [(1, 1), (37, 23)]


def test_data_keeps_32_bits_and_color_follows_the_precision(plan):
    graph = chain(Exposure(stops=1.0)).add("noise", Noise())
    graph = graph.add_output("field", Output(Kind.FIELD)).connect(Port("noise", "value"), Port("outputs", "field"))
    made = plan(graph, precision="half")
    assert made.surfaces[made.outputs["image"]].texel == "rgba16f"
    assert made.surfaces[made.outputs["field"]].texel == "r32f"


def test_too_large_is_made_by_tiles_and_says_why_with_numbers(plan):
    tiling = plan(_checker(8.0), size=(40000, 23)).tiling
    assert re.search(r"'a'.*40000x23.*16384", tiling.why)
    assert [region.size for region in tiling.last[0].tiles] == [(10000, 23)] * 4


def group(values=None) -> Group:
    body = chain(Exposure(stops=1.0)).add_control("light", Control(Port("a", "stops")))
    return Group(body, values=values or {})


def wrapped(inner: Group) -> Graph:
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    graph = graph.add("g", inner).connect(Port("inputs", "image"), Port("g", "image"))
    return graph.connect(Port("g", "image"), Port("outputs", "image"))


def test_a_group_is_its_body(plan):
    made, flat = plan(wrapped(group())), plan(chain(Exposure(stops=1.0)))
    assert made.surfaces[-1].key == flat.surfaces[-1].key
    assert made.passes[0].nodes == ("g/a",)


def test_a_control_sets_the_value_inside(plan):
    made, flat = plan(wrapped(group({"light": 3.0}))), plan(chain(Exposure(stops=3.0)))
    assert made.surfaces[-1].key == flat.surfaces[-1].key


def test_groups_nest_and_outputs_inside_them_work(plan):
    nested = wrapped(Group(wrapped(Group(wrapped(group())))))
    assert plan(nested).surfaces[-1].key == plan(chain(Exposure(stops=1.0))).surfaces[-1].key


def test_a_muted_group_passes_its_input(plan):
    graph = wrapped(group()).add("after", Exposure(stops=2.0)).connect(Port("g", "image"), Port("after", "image"))
    graph = graph.disconnect(Port("outputs", "image")).connect(Port("after", "out"), Port("outputs", "image"))
    assert plan(graph.mute("g", True)).surfaces[-1].key == plan(chain(Exposure(stops=2.0))).surfaces[-1].key


def test_an_unlinked_input_is_named(plan):
    graph = Graph(outputs={"image": Output()}).add("a", Exposure(stops=1.0))
    with pytest.raises(GraphError, match=r"'a'.*'image'.*not linked"):
        plan(graph.connect(Port("a", "out"), Port("outputs", "image")))


def test_explain_names_passes_nodes_formats_slots_and_bytes(plan):
    text = explain(plan(chain(Exposure(stops=1.0), Saturation(saturation=0.5))))
    assert "exposure + saturation  [a, b]" in text
    assert "37x23 rgba32f slot 1 (13.3 KiB)" in text
    assert "1 passes, 1 programs, 2 surfaces in 2 textures, peak 26.6 KiB" in text


def test_dot_has_every_pass_and_surface(plan):
    made = plan(chain(Exposure(stops=1.0), GaussianBlur(sigma=2.0)))
    text = write_dot(made)
    assert text.startswith("digraph") and text.rstrip().endswith("}")
    assert text.count("->") == sum(len(one.textures) for one in made.passes) + len(made.outputs)


def test_a_long_chain_compiles_in_one_go(plan):
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()})
    nodes = {f"n{index:04}": Exposure(stops=0.5) for index in range(1500)}
    links = {Port("n0000", "image"): Port("inputs", "image"), Port("outputs", "image"): Port("n1499", "out")}
    links |= {Port(f"n{index:04}", "image"): Port(f"n{index - 1:04}", "out") for index in range(1, 1500)}
    made = plan(Graph(nodes=nodes, links=links, inputs=graph.inputs, outputs=graph.outputs))
    assert sum(len(one.functions) for one in made.passes) == 1500

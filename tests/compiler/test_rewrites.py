"""What rewrites do to passes. That pixels stay is in tests/renderer/test_equivalence.py."""

from __future__ import annotations

from typing import Any

import pytest
from halation.compiler import Plan, Target, load_library
from halation.errors import ShaderError
from halation.glsl import parse
from halation.graph import Graph, Input, Output, Port
from halation.nodes import catalogue
from random_graphs import random_graph

NODES = catalogue()


def graph(nodes: dict[str, Any], links: dict[str, str], *outputs: str) -> Graph:
    """Nodes linked to a picture; `outputs` are nodes whose `out` is wanted."""
    made = Graph().add_input("image", Input())
    for id, node in nodes.items():
        made = made.add(id, node)
    for name in outputs:
        made = made.add_output(name, Output()).connect(Port(name, "out"), Port("outputs", name))
    for target, source in links.items():
        made = made.connect(Port.parse(source), Port.parse(target))
    return made


def functions(plan: Plan) -> list[tuple[str, ...]]:
    return [one.functions for one in plan.passes]


def labels(plan: Plan, numbers: tuple[int, ...]) -> list[str]:
    return [plan.surfaces[number].label for number in numbers]


def test_three_thresholds_of_a_picture_are_one_pass(plan) -> None:
    nodes = {name: NODES["bright_pass"](threshold=at) for name, at in (("low", 0.5), ("middle", 1.0), ("high", 2.0))}
    made = plan(graph(nodes, dict.fromkeys((f"{name}.image" for name in nodes), "inputs.image"), *nodes))
    assert functions(made) == [("bright_pass",) * 3]
    assert len(made.passes[0].textures) == 1 and sorted(labels(made, made.passes[0].targets)) == sorted(nodes)


def test_what_is_made_on_the_way_is_not_read_again(plan) -> None:
    """The tone-mapped picture is blurred, so it is stored; what else is made of it is made in the same pass."""
    nodes = {
        "tone": NODES["tone_map"](),
        "blur": NODES["bilateral_blur"](),
        "bright": NODES["bright_pass"](),
        "sum": NODES["merge"](mode="plus"),
    }
    links = {
        "tone.image": "inputs.image",
        "blur.image": "tone.out",
        "bright.image": "tone.out",
        "sum.a": "bright.out",
        "sum.b": "blur.out",
    }
    made = plan(graph(nodes, links, "sum"))
    assert functions(made) == [("tone_map",), ("bilateral_blur",), ("bright_pass", "merge")]
    made = plan(graph(nodes, links, "sum", "bright"))
    assert functions(made)[0] == ("tone_map", "bright_pass")
    assert labels(made, made.passes[0].targets) == ["tone", "bright"]


def test_what_nobody_else_wants_is_not_stored(plan) -> None:
    """Two that were each read by several: together they are all that reads what they have in common."""
    nodes = {
        "tone": NODES["tone_map"](),
        "one": NODES["exposure"](stops=1.0),
        "two": NODES["saturation"](saturation=0.5),
    }
    links = {"tone.image": "inputs.image", "one.image": "tone.out", "two.image": "tone.out"}
    made = plan(graph(nodes, links, "one", "two"))
    assert [set(one) for one in functions(made)] == [{"tone_map", "exposure", "saturation"}]
    assert set(labels(made, made.passes[0].targets)) == {"one", "two"}


def test_what_waits_for_another_pass_stays_behind_it(plan) -> None:
    """Both read the picture, but the second one also a blur of what the first one makes."""
    nodes = {
        "first": NODES["tone_map"](),
        "blur": NODES["bilateral_blur"](),
        "second": NODES["merge"](mode="plus"),
    }
    links = {
        "first.image": "inputs.image",
        "blur.image": "first.out",
        "second.a": "inputs.image",
        "second.b": "blur.out",
    }
    made = plan(graph(nodes, links, "second", "first"))
    assert functions(made) == [("tone_map",), ("bilateral_blur",), ("merge",)]


def test_what_others_look_around_in_is_not_computed_beside_them(plan) -> None:
    nodes = {"tone": NODES["tone_map"](), "edges": NODES["edge_detect"](), "light": NODES["exposure"](stops=1.0)}
    links = {"tone.image": "inputs.image", "edges.image": "tone.out", "light.image": "edges.out"}
    assert functions(plan(graph(nodes, links, "light", "tone"))) == [("tone_map",), ("edge_detect", "exposure")]


@pytest.mark.parametrize("most", [1, 2, 3])
def test_a_device_that_writes_less_gets_less(plan, most) -> None:
    nodes = {name: NODES["bright_pass"](threshold=at) for name, at in (("low", 0.5), ("middle", 1.0), ("high", 2.0))}
    asked = graph(nodes, dict.fromkeys((f"{name}.image" for name in nodes), "inputs.image"), *nodes)
    made = plan(asked, target=Target("small", 410, software=False, max_targets=most, form="fragment"))
    assert max(len(one.targets) for one in made.passes) == most and len(made.passes) == -(-3 // most)


def test_what_is_cheap_is_computed_twice_and_what_is_dear_stored(plan) -> None:
    """The blur comes between the two that read it, so they cannot be one pass."""

    def planned(middle: Any) -> Plan:
        nodes = {
            "before": middle,
            "bright": NODES["bright_pass"](),
            "blur": NODES["bilateral_blur"](),
            "sum": NODES["merge"](mode="plus"),
        }
        links = {
            "before.image": "inputs.image",
            "bright.image": "before.out",
            "blur.image": "bright.out",
            "sum.a": "before.out",
            "sum.b": "blur.out",
        }
        return plan(graph(nodes, links, "sum"))

    cheap, dear = planned(NODES["exposure"](stops=1.0)), planned(NODES["tone_map"]())
    assert functions(cheap) == [
        ("exposure", "bright_pass"),
        ("bilateral_blur",),
        ("exposure", "merge"),
    ]
    assert [len(one.targets) for one in cheap.passes] == [1, 1, 1]
    assert functions(dear)[0] == ("tone_map", "bright_pass") and len(dear.passes[0].targets) == 2
    assert len(cheap.surfaces) == len(dear.surfaces) - 1


def test_a_value_changes_no_key_but_its_own(plan) -> None:
    """What shares a pass does not depend on each other: the results of one outlive a change of the other."""

    def keys(threshold: float) -> dict[str, str]:
        nodes = {"tone": NODES["tone_map"](), "bright": NODES["bright_pass"](threshold=threshold)}
        made = plan(graph(nodes, {"tone.image": "inputs.image", "bright.image": "tone.out"}, "tone", "bright"))
        assert len(made.passes) == 1
        return {name: made.surfaces[number].key for name, number in made.outputs.items()}

    one, other = keys(1.0), keys(2.0)
    assert one["tone"] == other["tone"] and one["bright"] != other["bright"]


def focused() -> Graph:
    """A lens, and no pictures but one."""
    lens = NODES["depth_of_field"](max_blur=0.5, quality="draft")
    links = {"lens.image": "inputs.image", "depth.image": "inputs.image", "lens.depth": "depth.out"}
    return graph({"lens": lens, "depth": NODES["luminance"]()}, links, "lens")


def test_what_a_function_makes_at_once_is_one_pass(plan) -> None:
    made = plan(focused())
    several = [one for one in made.passes if one.functions == ("depth_of_field_near",)]
    assert several and all(len(one.targets) == 2 for one in several)
    assert all(made.surfaces[one.targets[1]].channels == 1 for one in several)


def test_a_function_must_make_what_it_is_drawn_for(plan) -> None:
    text = load_library().texts["lens/depth_of_field"]
    other = parse(text.name, text.body.replace("out float covers", "out vec2 covers"), text.file)
    with pytest.raises(ShaderError, match=r"makes \(vec4, vec2\) but is drawn for \(vec4, float\)"):
        plan(focused(), library=load_library().with_replacement(other, "other"))


def test_random_graphs_have_merged_passes(plan) -> None:
    """So that what the random graphs prove is proven of them as well."""
    merged = [
        one
        for seed in range(40)
        for made in [plan(random_graph(seed))]
        for one in made.passes
        if len(set(labels(made, one.targets))) > 1
    ]
    assert len(merged) > 40

"""Rules find what they are about, and nothing in what is fine."""

from __future__ import annotations

import ast
import dataclasses
from pathlib import Path

import pytest
from halation.compiler import Request, compile_graph
from halation.document import dumps, load, loads
from halation.errors import HalationError
from halation.graph import Expression, Graph, Group, Input, Output, Port
from halation.graph import rules as graph_rules
from halation.lint.checking import RULES, GraphChecker
from halation.lint.rules import CHECKS
from halation.lint.sheet import GraphFacts
from halation.nodes import Kind
from halation.resources.picture import Picture
from halation.resources.provider import PictureProbe
from halation.resources.sandbox import UNRESTRICTED
from lint_graphs import BLOOM, DIM, DOUBLE, HALF, MOVE, NEAREST, NODES, SOFT, STILL, TONE, TURN, WRAPPED, chain

ROOT = Path(__file__).parents[2]
PRESETS = sorted((ROOT / "presets").glob("*.json"))


def found(graph: Graph) -> list[tuple[str, str]]:
    """Rule and node of what the rules about graphs say."""
    sheet = GraphFacts(graph)
    return sorted((one.rule.name, one.node) for check in CHECKS for one in check.find(sheet))


@pytest.mark.parametrize(
    ("steps", "at"),
    [
        ((TURN, DIM, MOVE), "c"),
        ((TURN, DIM, ("saturation", {"saturation": 0.5}), MOVE), "d"),
        ((HALF, HALF), "b"),
        ((DOUBLE, DOUBLE), "b"),
        ((TURN, HALF), "b"),
        ((HALF, TURN), "b"),
        ((SOFT, SOFT), "b"),
        ((TURN, STILL, DIM, MOVE), "d"),
    ],
)
def test_filtered_twice(steps, at) -> None:
    assert found(chain(*steps)) == [("filtering-twice", at)]


@pytest.mark.parametrize(
    "steps",
    [
        (TURN, MOVE),
        (TURN, STILL, MOVE),
        (TURN, DIM, WRAPPED),
        (TURN, DIM, NEAREST),
        (HALF, DOUBLE),
        (DOUBLE, HALF),
        (TURN, DOUBLE),
        (TURN, ("vignette", {"amount": 0.5}), MOVE),
        (SOFT, DIM, SOFT),
        (TURN, SOFT, MOVE),
        (DIM, MOVE),
    ],
)
def test_filtered_once_or_meant(steps) -> None:
    assert found(chain(*steps)) == []


def test_a_picture_that_others_read_as_well_is_needed_as_it_is() -> None:
    graph = chain(TURN, DIM, MOVE).add_output("turned", Output())
    assert found(graph.connect(Port("b", "out"), Port("outputs", "turned"))) == []
    assert found(graph.connect(Port("c", "out"), Port("outputs", "turned"))) == [("filtering-twice", "c")]


class Nowhere:
    """Every picture is half as large as HD."""

    def probe_picture(self, picture: Picture) -> PictureProbe:
        return PictureProbe((960, 540), False, picture.path)


def resamplings(graph: Graph) -> int:
    bound = {"beauty": Picture("beauty", "", Kind.IMAGE, 4, in_memory=True)}
    plan = compile_graph(graph, Request(bindings=bound), Nowhere())
    return sum("vec4 place" in one.shader.source for one in plan.passes)


def test_the_compiler_says_the_same_of_transforms() -> None:
    """What is found costs two resamplings, and the way out that is named costs one."""
    assert [resamplings(chain(*steps)) for steps in ((TURN, DIM, MOVE), (TURN, MOVE, DIM), (TURN, MOVE))] == [2, 1, 1]


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        ((TONE, BLOOM), "b"),
        ((TONE, DIM, SOFT, BLOOM), "d"),
        ((TONE, TONE), "b"),
        ((TONE, BLOOM, BLOOM), "b"),
        ((("local_tone_map", {}), ("depth_of_field", {})), "b"),
    ],
)
def test_light_behind_a_tone_map(steps, expected) -> None:
    graph = chain(*steps)
    if "depth_of_field" in {item.id for item in graph.nodes.values()}:
        graph = graph.add_input("z", Input(Kind.FIELD, default=1.0)).connect(Port("inputs", "z"), Port("b", "depth"))
    assert found(graph) == [("display-light", expected)]


@pytest.mark.parametrize(
    "steps",
    [
        (BLOOM, TONE),
        (TONE, DIM, ("saturation", {"saturation": 0.5})),
        (TONE, ("film_grain", {})),
        (DIM, BLOOM),
    ],
)
def test_light_before_a_tone_map(steps) -> None:
    assert found(chain(*steps)) == []


def test_the_output_of_a_preset_is_for_the_display_if_it_says_so() -> None:
    for view, expected in (("none", [("display-light", "b")]), ("", [])):
        body = dataclasses.replace(chain(DIM), outputs={"image": Output(view=view)})
        graph = Graph(inputs={"beauty": Input()}, outputs={"image": Output()}).add("a", Group(body))
        graph = graph.add("b", NODES["bloom"]()).connect(Port("inputs", "beauty"), Port("a", "beauty"))
        graph = graph.connect(Port("a", "image"), Port("b", "image"))
        assert found(graph.connect(Port("b", "out"), Port("outputs", "image"))) == expected


def test_light_of_a_file_of_bytes() -> None:
    assert found(chain(BLOOM, file="a/photo.JPG")) == [("clipped-light", "a")]
    assert found(chain(BLOOM, file="shot.exr")) == found(chain(BLOOM, file="shot.png")) == []
    assert found(chain(("exposure", {"stops": 1.0}), file="photo.jpg")) == []


@pytest.mark.parametrize("type_name", ["deferred_lighting", "geometry_edges"])
def test_what_works_on_surfaces_and_has_none(type_name: str) -> None:
    node = NODES[type_name]()
    graph = Graph().add_input("layer", Input(Kind.FIELD)).add_output("out", Output(Kind.FIELD)).add("a", node)
    assert ("no-surface", "a") in found(graph)
    for name in {"depth", "normal", "position", "ids"} & node.inputs.keys():
        kind, channels = node.inputs[name].kind, node.inputs[name].channels
        linked = graph.add_input("one", Input(kind, channels)).connect(Port("inputs", "one"), Port("a", name))
        assert "no-surface" not in [rule for rule, _ in found(linked)], name


@pytest.mark.parametrize(
    ("layer", "is_data"),
    [
        ("Depth", True),
        ("ViewLayer.Normal", True),
        ("Depth.Z", True),
        ("CryptoObject00", True),
        ("object_id", True),
        ("N", True),
        ("P", True),
        ("Combined", False),
        ("", False),
        ("Diffuse", False),
        ("Emission", False),
        ("Normal light", False),
        ("AmbientOcclusion", False),
        ("Position light.rgb", False),
    ],
)
def test_data_where_color_is_wanted(layer, is_data) -> None:
    expected = [("data-as-color", "a")] if is_data else []
    assert found(chain(("saturation", {"saturation": 0.5}), file="shot.exr", layer=layer)) == expected
    assert found(chain(("levels", {"gamma": (2.0, 2.0, 2.0, 1.0)}), file="shot.exr", layer=layer)) == []


def test_data_by_the_name_of_an_input_or_an_output() -> None:
    graph = Graph(inputs={"depth": Input(Kind.FIELD)}, outputs={"image": Output()}).add("a", NODES["bloom"]())
    graph = graph.connect(Port("a", "out"), Port("outputs", "image"))
    graph = graph.connect(Port("inputs", "depth"), Port("a", "image"))
    assert found(graph) == [("data-as-color", "a")]
    read = graph.remove_input("depth").add("r", NODES["read_render"](path="shot.exr"))
    for socket, expected in (("depth", [("data-as-color", "a")]), ("color", []), ("occlusion", [])):
        assert found(read.connect(Port("r", socket), Port("a", "image"))) == expected


def test_unused() -> None:
    graph = chain(DIM)
    for id, before in (("x", "inputs.beauty"), ("y", "x.out"), ("z", "y.out")):
        graph = graph.add(id, NODES["exposure"](stops=1.0)).connect(Port.parse(before), Port(id, "image"))
    assert found(graph) == [("unused-branch", "z")]
    assert found(graph.animate(Port("a", "gamma"), Expression("z.stops"))) == []
    assert found(dataclasses.replace(graph, ui={"viewers": {"1": "z.out"}})) == []
    assert found(chain(DIM).add_input("spare", Input())) == [("unused-input", "inputs")]
    names = ("a", "gone", "inputs.beauty", "inputs.gone", "outputs.image")
    layout = {"nodes": {name: {"x": 0, "y": 0} for name in names}}
    assert found(dataclasses.replace(chain(DIM), ui=layout)) == [("stale-layout", "")] * 2


@pytest.mark.parametrize(
    ("path", "rule"),
    [
        ("/shots/a.exr", "absolute-path"),
        ("C:/shots/a.exr", "absolute-path"),
        (r"C:\shots\a.exr", "absolute-path"),
        (r"\\server\shots\a.exr", "absolute-path"),
        (r"shots\a.exr", "backslash-path"),
        ("shots/a.exr", ""),
        ("../a.####.exr", ""),
        ("", ""),
        ("c.exr", ""),
    ],
)
def test_paths(path, rule) -> None:
    assert found(chain(DIM, file=path)) == ([(rule, "inputs")] if rule else [])
    graph = chain(DIM).add("r", NODES["read_image"](path=path)).connect(Port("r", "out"), Port("a", "image"))
    assert (rule, "r") in found(graph) or not rule


@pytest.mark.parametrize("path", PRESETS, ids=[path.stem for path in PRESETS])
def test_presets_are_clean(path) -> None:
    assert [one.problem.sentence for one in GraphChecker(sandbox=UNRESTRICTED).check_file(path).findings] == []


def test_every_rule_can_be_looked_up_and_says_what_to_do() -> None:
    declared = {value for value in vars(graph_rules).values() if isinstance(value, graph_rules.Rule)}
    assert declared == set(graph_rules.RULES) and declared <= set(RULES.values())
    for name, rule in RULES.items():
        assert name == rule.name == name.lower() and " " not in name
        assert rule.doc.endswith(".") and rule.way_out.endswith(".")
    assert {check.rule for check in CHECKS} <= set(RULES.values())


def test_every_fault_of_reading_has_a_rule() -> None:
    named = [
        keyword.value.value
        for path in (ROOT / "app" / "document").rglob("*.py")
        for call in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(call, ast.Call)
        for keyword in call.keywords
        if keyword.arg == "rule" and isinstance(keyword.value, ast.Constant)
    ]
    assert len(named) >= 8 and set(named) <= RULES.keys()


def test_checking_refuses_what_compiling_refuses(tmp_path) -> None:
    """A graph with errors only in the whole: the exit code is that of the compiler."""
    text = dumps(chain(*[("resize", {"scale": (64.0, 64.0)})] * 2))
    made = loads(text, sandbox=UNRESTRICTED)
    bound = {"beauty": Picture("beauty", "", Kind.IMAGE, 4, in_memory=True)}
    with pytest.raises(HalationError) as caught:
        compile_graph(made, Request(bindings=bound), Nowhere())
    report = GraphChecker(UNRESTRICTED, frozenset({"unbound-input", "filtering-twice"})).check_text(
        text, "big.json", str(tmp_path)
    )
    assert [(one.problem.rule.name, one.code) for one in report.findings] == [("too-large", caught.value.exit_code)]


def test_lines_of_a_preset_lead_to_the_node() -> None:
    path = ROOT / "presets" / "agx_look.json"
    text = path.read_text().replace('"type": "saturation"', '"type": "saturatoin"')
    (one,) = GraphChecker(sandbox=UNRESTRICTED).check_text(text, "a.json", str(path.parent)).findings
    assert one.problem.rule.name == "unknown-type" and '"color": {' in text.splitlines()[one.line - 1]
    assert load(path, sandbox=UNRESTRICTED).nodes["color"].id == "saturation"

"""Controls as numbers, and samples of a graph at other values of them."""

import pytest
from halation.compiler.knobs import FRAME, GraphSampler, Knob, find_knob_controls
from halation.errors import GraphError
from halation.graph import Control, Graph, Port
from halation.nodes import Value, catalogue


@pytest.fixture
def graph() -> Graph:
    names = catalogue()
    graph = Graph().add("grade", names["exposure"](stops=0.5)).add("move", names["transform"]())
    graph = graph.add_control("gain", Control(Port("grade", "stops"), label="Gain"))
    return graph.add_control(FRAME, Control(Port("move", "position"))).add_control(
        "edge", Control(Port("move", "edge"))
    )


def find(graph: Graph):
    return find_knob_controls(graph, lambda value: value.type in ("float", "vector"))


def test_each_component_is_a_knob_with_a_name_of_its_own(graph) -> None:
    controls, remarks = find(graph)
    assert [(control.name, control.label) for control in controls] == [("gain", "Gain"), (FRAME, "")]
    assert [knob.name for control in controls for knob in control.knobs] == ["gain", "frame.0.0", "frame.0.1"]
    assert remarks == {"edge": "keeps its value: the format has no input for a choice like it"}


def test_a_linked_value_cannot_be_changed(graph) -> None:
    graph = graph.add("light", catalogue()["luminance"]()).connect(Port("light", "out"), Port("grade", "stops"))
    assert find(graph)[1]["gain"] == "cannot be changed: it is animated or linked"


def test_a_graph_is_compiled_once_for_each_point_with_its_controls_set(graph) -> None:
    points = []

    def compile_at(at: Graph, point) -> tuple[object, object]:
        points.append(point)
        if point.get(FRAME) == 7.0:
            raise GraphError("there is no such frame")
        return at.nodes["grade"].stops, at.nodes["move"].position

    sampler = GraphSampler(graph, find(graph)[0], compile_at)
    rest = graph.nodes["move"].position
    assert sampler.take({}) == (0.5, rest)
    assert sampler.take({"gain": 2.0, FRAME: 1.0}) == sampler.take({FRAME: 1.0, "gain": 2.0}) == (2.0, rest)
    assert sampler.take({"frame.0.1": 3.0})[1] == (rest[0], 3.0)
    assert len(points) == 3
    assert sampler.try_take({FRAME: 7.0}) is None
    with pytest.raises(GraphError):
        sampler.take({FRAME: 7.0})


def test_a_knob_stays_in_its_range() -> None:
    assert [Knob("n", 1.0, 0.0, 4.0, is_whole=True).snap(x) for x in (-1.0, 1.4, 9.0)] == [0.0, 1.0, 4.0]
    assert Knob("n", 1.0, 0.0, 4.0).snap(1.4) == 1.4
    assert Value("v", "float", 0.0).length == 1

"""Hundreds of strokes are drawn in few passes, of which a new stroke leaves most as they are."""

from __future__ import annotations

from halation.compiler import Request, compile_graph
from halation.graph import Graph, Output, Port, Settings
from halation.inputs.lazy_provider import LazyResourceProvider
from halation.nodes import Kind, PaintStroke, name_paint_strokes
from halation.nodes.filter.paint import Paint
from halation.nodes.input.constant import Constant
from halation.resources.sandbox import UNRESTRICTED


def plan_strokes(count: int) -> list[str]:
    """The keys of the passes that draw a number of strokes: passes with equal keys are not made again."""
    way = (0.2, 0.4, 1.0, 0.7, 0.5, 1.0)
    strokes = {f"s{number:04}": PaintStroke(points=way, size=0.04 + 0.01 * (number % 5)) for number in range(count)}
    names = name_paint_strokes(**strokes)
    graph = Graph(settings=Settings(size=(101, 75))).add("paint", Paint(strokes=names)).add("back", Constant())
    graph = graph.add_output("image", Output(Kind.IMAGE)).connect(Port("back", "out"), Port("paint", "image"))
    graph = graph.connect(Port("paint", "out"), Port("outputs", "image"))
    plan = compile_graph(graph, Request({}, {}, None, 1.0, 1), LazyResourceProvider(UNRESTRICTED))
    return [plan.surfaces[item.targets[0]].key for item in plan.passes if "paint_run" in item.functions]


def test_hundreds_of_strokes_are_few_passes():
    """500 are one of 256, then 128, 64, 32, the 19 that are left, and the one that may still be drawn."""
    assert len(plan_strokes(500)) == 6
    assert len(plan_strokes(1000)) == 8


def test_a_new_stroke_mostly_leaves_those_before_it():
    """From 300 to 330 strokes, the passes of the first 256 stay, and few of the others are made again."""
    before, made = plan_strokes(300), 0
    for count in range(301, 331):
        keys = plan_strokes(count)
        assert keys[0] == before[0]
        made += len(set(keys) - set(before))
        before = keys
    assert made <= 2.2 * 30  # the pass of the new stroke, that of the last few, and now and then a larger one

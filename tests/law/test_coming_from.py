"""What docs/coming-from.md says of Halation is true: nodes, expressions, and what a merge does."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from halation.graph import Graph, Input, Output, Port
from halation.graph.expressions import Expression
from halation.nodes import Kind, built_in_nodes
from halation.nodes.merge.merge import Merge

PAGE = (Path(__file__).parents[2] / "docs" / "coming-from.md").read_text(encoding="utf-8")
PROGRAMS = "Blender|Nuke|Fusion|After Effects|ReShade"
EXPRESSIONS = re.findall(rf"^\| (?:{PROGRAMS}) \| .*`.* \| `(.*)` \|$", PAGE, re.M)

AT_FRAME_13 = {
    "mix(0, 5, frame / 24)": 65 / 24,
    "floor(frame / 2)": 6.0,
    "frame > 10 ? 1 : 0": 1.0,
    "[0.5, 0.25]": (0.5, 0.25),
    "time * 90": 45.0,
    "fit(time, 0, 2, 0, 100)": 25.0,
    "mix(0, 100, smoothstep(0, 2, time))": 15.625,
    "sin(time)": math.sin(0.5),
    "time * 1000": 500.0,
    "blur.sigma * 2": 6.0,
}
"""What the other program's formula gives at frame 13 of 24 per second, half a second after the start."""


def test_every_node_that_is_named_exists() -> None:
    assert set(re.findall(r"nodes\.md#(\w+)", PAGE)) <= built_in_nodes().keys()


@pytest.mark.parametrize("text", sorted(set(EXPRESSIONS)))
def test_an_expression_is_valid(text: str) -> None:
    value = Expression(text).evaluate(13.0, 0.5, 24.0, {"blur.sigma": 3.0}.__getitem__)
    assert value == pytest.approx(AT_FRAME_13[text]) if text in AT_FRAME_13 else np.isfinite(value)


def test_the_table_of_expressions_is_found() -> None:
    assert len(EXPRESSIONS) == 18 and set(EXPRESSIONS) >= AT_FRAME_13.keys()


@pytest.mark.parametrize("muted", [False, True])
def test_a_merge_has_the_size_of_its_background_and_passes_its_foreground_if_muted(run, muted: bool) -> None:
    graph = Graph().add("merge", Merge()).mute("merge", muted).add_output("image", Output(Kind.IMAGE))
    for name in ("a", "b"):
        graph = graph.add_input(name, Input(Kind.IMAGE)).connect(Port("inputs", name), Port("merge", name))
    graph = graph.connect(Port("merge", "out"), Port("outputs", "image"))
    green = np.full((4, 4, 4), (0.0, 0.5, 0.0, 0.5), np.float32)
    blue = np.full((8, 8, 4), (0.0, 0.0, 1.0, 1.0), np.float32)
    merged = run(graph, {"a": green, "b": blue})
    assert merged.shape == (8, 8, 4)
    wanted = (0.0, 0.5, 0.0, 0.5) if muted else (0.0, 0.5, 0.5, 1.0)
    np.testing.assert_allclose(merged, np.broadcast_to(wanted, merged.shape), atol=1e-6)

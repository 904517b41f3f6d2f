"""Outlines of any size are drawn by programs that a driver compiles once."""

from __future__ import annotations

from halation.graph import Graph, Output, Port
from halation.nodes.input.text import Text


def test_tables_of_outlines_have_no_height_for_which_mesa_compiles_again(plan) -> None:
    """It tells apart whether a side of a picture is a power of two. Widths always are one, heights never."""
    kinds = set[tuple[bool, bool]]()
    rows = set[int]()
    for count in (1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144, 233):
        made = Graph(
            nodes={"text": Text(text="Rg" * count, size=0.9 / count)},
            outputs={"out": Output()},
            links={Port("outputs", "out"): Port("text", "out")},
        )
        planned = plan(made, size=(640, 480))
        (drawing,) = (one for one in planned.passes if any("covers" in name for name in one.functions))
        for number in (*drawing.textures, *drawing.targets):
            width, height = planned.surfaces[number].size
            rows.add(height)
            kinds.add((width.bit_count() == 1, height.bit_count() == 1))
    assert kinds == {(True, False)} and len(rows) > 8

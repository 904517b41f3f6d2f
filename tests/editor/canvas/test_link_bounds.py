"""Which links may be seen in a rectangle: a curve stays among its handles, and what touches the border counts."""

from __future__ import annotations

import pytest
from halation.editor.canvas.link_index import LinkIndex, Wire
from halation.graph import Port

RECT = (10.0, 20.0, 30.0, 40.0)
Span = tuple[float, float]


def wire(name: str, across: Span, down: Span, more: tuple[Span, Span] | None = None) -> Wire:
    """A link of one or two curves, each from a left top to a right bottom corner."""
    spans = [(across, down), *([more] if more else [])]
    curves = tuple(((x0, y0), (x0, y1), (x1, y0), (x1, y1)) for (x0, x1), (y0, y1) in spans)
    return Wire(Port(name, "image"), Port("a", "out"), (), None, curves)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("across", "down", "is_seen"),
    [
        ((12.0, 14.0), (22.0, 24.0), True), ((0.0, 90.0), (0.0, 90.0), True), ((0.0, 9.0), (22.0, 24.0), False),
        ((31.0, 35.0), (22.0, 24.0), False), ((12.0, 14.0), (0.0, 19.0), False), ((12.0, 14.0), (41.0, 50.0), False),
        ((0.0, 10.0), (22.0, 24.0), True), ((30.0, 35.0), (22.0, 24.0), True), ((12.0, 14.0), (0.0, 20.0), True),
        ((12.0, 14.0), (40.0, 50.0), True),
    ],
)  # fmt: skip
def test_a_link_is_listed_that_reaches_the_rectangle(across: Span, down: Span, is_seen: bool) -> None:
    links = LinkIndex((wire("far", (100.0, 101.0), (100.0, 101.0)), wire("b", across, down)))
    assert [found.target.node for found in links.list_visible(RECT)] == ["b"] * is_seen


def test_all_curves_of_a_link_count() -> None:
    far = ((100.0, 101.0), (100.0, 101.0))
    links = LinkIndex(
        (wire("b", *far, ((12.0, 13.0), (22.0, 23.0))), wire("c", *far), wire("d", (12.0, 13.0), (22.0, 23.0), far))
    )
    assert [found.target.node for found in links.list_visible(RECT)] == ["b", "d"]
    assert LinkIndex().list_visible(RECT) == [] and LinkIndex().find_near(0.0, 0.0, 9.0) is None

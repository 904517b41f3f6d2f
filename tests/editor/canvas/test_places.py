"""Where the parts of an element are on the screen: the canvas is zoomed about its corner, and then moved."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from halation.editor.canvas.brush import DETAILS_FROM
from halation.editor.canvas.places import _find_box_rects, _find_wire_rect  # pyright: ignore[reportPrivateUsage]
from halation.graph import Port

TO: Any = SimpleNamespace(scale=2.0, to_screen=lambda x, y: (2.0 * x + 100.0, 2.0 * y - 50.0))
VALUE = SimpleNamespace(name="sigma")


def brush(**changes: Any) -> Any:
    return SimpleNamespace(
        **({"to": TO, "visible": (0.0, 0.0, 500.0, 500.0), "header": 24.0, "zoom": DETAILS_FROM} | changes)
    )


def box(**changes: Any) -> Any:
    rows = [
        SimpleNamespace(value=VALUE, field=(5.0, 30.0, 95.0, 50.0)), SimpleNamespace(value=None, field=(0, 0, 1, 1)),
        SimpleNamespace(value=SimpleNamespace(name="hidden"), field=None),
    ]  # fmt: skip
    layout = SimpleNamespace(
        ins={"image": SimpleNamespace(x=0.0, y=40.0)}, outs={"out": SimpleNamespace(x=100.0, y=44.0)},
        picture=(10.0, 60.0, 90.0, 80.0), rows=rows, more=(40.0, 82.0, 60.0, 88.0),
    )  # fmt: skip
    facts: dict[str, Any] = {
        "key": "blur", "x": 20.0, "y": 30.0, "w": 100.0, "h": 90.0, "rect": (20.0, 30.0, 120.0, 120.0),
        "layout": layout, "make_port": lambda pin, is_output: Port("blur", "out" if is_output else "image"),
    }  # fmt: skip
    return SimpleNamespace(**(facts | changes))


def test_parts_of_a_node() -> None:
    """The node begins at (20, 30), which is (140, 10) on the screen, where all is twice as large."""
    assert _find_box_rects(box(), brush()) == {
        "node blur": (140.0, 10.0, 340.0, 190.0),
        "title blur": (140.0, 10.0, 340.0, 58.0),
        "pin in blur.image": (130.0, 80.0, 150.0, 100.0),
        "pin out blur.out": (330.0, 88.0, 350.0, 108.0),
        "picture blur": (160.0, 130.0, 320.0, 170.0),
        "widget blur.sigma": (150.0, 70.0, 330.0, 110.0),
        "more blur": (220.0, 174.0, 260.0, 186.0),
    }


def test_details_are_where_they_are_drawn() -> None:
    far = _find_box_rects(box(), brush(zoom=DETAILS_FROM * 0.99))
    assert "picture blur" in far and not any(name.startswith(("widget", "more")) for name in far)
    plain = box(layout=SimpleNamespace(ins={}, outs={}, picture=None, rows=[], more=None))
    assert {*_find_box_rects(plain, brush())} == {"node blur", "title blur"}
    assert {*_find_box_rects(box(layout=None), brush())} == {"node blur", "title blur"}


def test_a_title_is_no_higher_than_its_element_and_what_is_out_of_view_has_no_place() -> None:
    low = _find_box_rects(box(h=8.0, layout=None), brush())
    assert low["node blur"] == low["title blur"] == (140.0, 10.0, 340.0, 26.0)
    assert _find_box_rects(box(rect=(600.0, 0.0, 700.0, 10.0)), brush()) == {}


def test_a_link_is_found_at_its_middle() -> None:
    wire: Any = SimpleNamespace(target=Port("blur", "image"), middle=(10.0, 30.0))
    assert _find_wire_rect(wire, TO) == ("link blur.image", (118.0, 8.0, 122.0, 12.0))

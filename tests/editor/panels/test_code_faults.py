"""The fault that the panel of code shows: of the text, or else of the shader in the last render."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.custom_nodes import Code, node_type
from halation.editor.code.page import Fault, Page
from halation.editor.theme.palette import DARK
from halation.errors import ShaderError
from halation.graph import Unknown

GOOD, BAD = Code("glsl", "vec4 f(vec4 image) { return image; }"), Code("glsl", "vec4 f(vec4 image) {\n return image;")
NODE = node_type(GOOD)()


def find(item: Any, *, code: Code | None = None, error: Any = None, page: Any = None) -> Fault | None:
    session = SimpleNamespace(
        graph=SimpleNamespace(nodes={"a": item}), code_files=SimpleNamespace(find_code=lambda id: code)
    )
    context = SimpleNamespace(session=session, preview=SimpleNamespace(errors={"g/a": error}))
    page = page or SimpleNamespace(id="a", path="g/a", _checked_code=(None, None))
    page.context = context
    return Page._find_fault(page)  # pyright: ignore


def test_code_that_is_no_node_has_the_fault_of_its_text() -> None:
    page: Any = SimpleNamespace(id="a", path="g/a", _checked_code=(None, None))
    fault = find(Unknown("code", {}, fault="it is broken"), code=BAD, page=page)
    assert fault is not None and fault.line >= 1 and "it is broken" not in fault.sentence
    page._checked_code = (BAD, Fault(7, "as before"))
    assert find(Unknown("code", {}, fault="it is broken"), code=BAD, page=page) == Fault(7, "as before"), "read once"
    assert find(Unknown("code", {}, fault="it is broken"), code=GOOD, page=page) == Fault(0, "it is broken")
    assert find(Unknown("code", {}, fault="it is broken")) == Fault(0, "it is broken"), "its text is not there"


@pytest.mark.parametrize("error", [None, ValueError("no")])
def test_code_without_an_error_has_no_fault(error: Any) -> None:
    assert find(NODE, error=error) is None and find(None, error=error) is None


def test_the_driver_s_error_belongs_to_its_line_where_it_is_in_this_text() -> None:
    assert NODE.text is not None
    here, elsewhere = NODE.text.file, "color/exposure.glsl"
    assert find(NODE, error=ShaderError("a", here, 3, "error: no such name ")) == Fault(3, "no such name")
    assert find(NODE, error=ShaderError("a", elsewhere, 3, "bad")) == Fault(0, f"{elsewhere}, line 3: bad")
    assert find(SimpleNamespace(), error=ShaderError("a", here, 3, "bad")) is None, "no code of a user"


def test_a_fault_names_its_line_or_begins_with_a_capital() -> None:
    assert Fault(0, "nan is no number").text == "Nan is no number"
    assert Fault(3, "no such name").text == "Line 3: no such name"
    assert Fault(2, "").text == "Line 2: "


class Lines:
    """Stands for the widget with the text: five lines, of which some are marked."""

    def __init__(self) -> None:
        self.marked, self.cleared = list[tuple[int, str]](), 0

    def get_line_count(self) -> int:
        return 5

    def clear_markers(self) -> None:
        self.marked.clear()
        self.cleared += 1

    def add_marker(self, line: int, number: int, back: int, tip: str, text: str) -> None:
        assert tip == text and number >> 24 < back >> 24 < 255, "the text stays legible"
        self.marked.append((line, text))


def test_the_line_of_a_fault_is_marked_once_until_something_changes() -> None:
    lines, faults = Lines(), list[Fault | None]()
    page: Any = SimpleNamespace(
        widget=lines, context=SimpleNamespace(palette=DARK), _find_fault=lambda: faults[-1], _theme="dark",
        _committed="text", _marker_inputs=None,
    )  # fmt: skip
    for fault, marked in (
        (Fault(3, "no such name"), [(2, "no such name")]),
        (Fault(9, "it ends too soon"), [(4, "it ends too soon")]),
        (Fault(0, "of another file"), []),
        (Fault(1, "again"), [(0, "again")]),
        (None, []),
    ):
        faults.append(fault)
        before = lines.cleared
        for _ in range(3):
            Page._update_markers(page)  # pyright: ignore[reportPrivateUsage]
        assert (page.fault, lines.marked, lines.cleared - before) == (fault, marked, 1)
    for name in ("_theme", "_committed"):
        setattr(page, name, "other")
        Page._update_markers(page)  # pyright: ignore[reportPrivateUsage]
    assert lines.cleared == 7

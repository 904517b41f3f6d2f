"""Lines of JSON paths, however the text is laid out. The reference is a writer that counts lines while it writes."""

from __future__ import annotations

import json

import pytest
from halation.document import loads
from halation.document.positions import Positions
from halation.document.syntax import member
from halation.errors import DocumentError
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given, settings
from hypothesis import strategies as st

SPACES = st.sampled_from(["", "", " ", "\n", "\r\n", "\n\n  ", "\t"])
KEYS = st.text(max_size=4) | st.sampled_from(["bloom.image", 'a"b', "\\", "{", "],", "\n", "é", "\U0001f600"])
TREES = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 9) | st.floats(-1, 1) | KEYS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=3),
    max_leaves=12,
)


class Writer:
    """Writes JSON with any white space between tokens, and notes on which line every part begins."""

    def __init__(self, draw, escape: bool) -> None:
        self.draw, self.escape = draw, escape
        self.text, self.lines = "", dict[str, int]()

    def space(self) -> None:
        self.text += self.draw(SPACES)

    def note(self, path: str) -> None:
        self.lines.setdefault(path, self.text.count("\n") + 1)

    def scalar(self, item) -> None:
        self.text += json.dumps(item, ensure_ascii=self.escape)

    def write(self, item, path: str) -> None:
        if not isinstance(item, dict | list):
            self.scalar(item)
            return
        self.text += "{" if isinstance(item, dict) else "["
        pairs = item.items() if isinstance(item, dict) else enumerate(item)
        for place, (key, part) in enumerate(pairs):
            self.text += "," if place else ""
            self.space()
            self.note(where := member(path, key))
            if isinstance(item, dict):
                self.scalar(key)
                self.space()
                self.text += ":"
                self.space()
            self.write(part, where)
            self.space()
        self.text += "}" if isinstance(item, dict) else "]"


@settings(max_examples=150)
@given(st.data(), TREES, st.booleans())
def test_every_part_is_where_it_was_written(data, tree, escape) -> None:
    writer = Writer(data.draw, escape)
    writer.space()
    writer.note("")
    writer.write(tree, "")
    assert json.loads(writer.text) == tree
    found = Positions(writer.text, writer.lines)
    assert {path: found.line(path) for path in writer.lines} == writer.lines


@settings(max_examples=100)
@given(st.text(alphabet='{}[],:"\\ab1 \n', max_size=40), st.text(alphabet="ab.[]0", max_size=6))
def test_damaged_text_has_lines_too(text, path) -> None:
    assert 1 <= Positions(text, [path]).line(path) <= text.count("\n") + 1


def test_what_is_not_there_is_where_it_would_be() -> None:
    paths = ("nodes.a.values.b.c", "nodes.a.version", "nodes.b", "links.a.image")
    found = Positions('{\n"nodes": {\n"a": {"type": "x",\n"values": {}}}}', paths)
    assert [found.line(path) for path in paths] == [4, 3, 2, 1]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ('{"halation": 1,\n"nodes": {\n"a": {},\n\n"a": {}}}', 5),
        ('{"halation": 1,\n"links": {"b.image": "c.out",\n"a.image": 5}}', 3),
        ('{"halation": 1,\n"settings": {"size": [1,\n0]}}', 3),
        ('{"halation": 1, "nodes": {"g": {"type": "group",\n"graph": {"nodes":\n{"in": {"muted": 1}}}}}}', 3),
    ],
    ids=["twice", "link", "list", "group"],
)
def test_the_path_of_a_fault_leads_to_its_line(text, line) -> None:
    with pytest.raises(DocumentError) as caught:
        loads(text, sandbox=UNRESTRICTED)
    assert Positions(text, [caught.value.path]).line(caught.value.path, last=True) == line

"""The nodes of a graph and of its groups, however deep."""

from __future__ import annotations

from pathlib import Path

from halation.authoring.edits.coding import file_texts
from halation.custom_nodes import Code, node_type
from halation.graph import Graph, Group
from halation.watch.code_files import code_items


def coded(file: str, *groups: Group) -> Graph:
    """A graph with one node whose code is in a file, and these groups."""
    node = node_type(Code("glsl", f"vec4 f(vec4 image) {{ return image; }} // {file}", file))()
    return Graph({"code": node, **{f"g{number}": group for number, group in enumerate(groups)}})


DEEP = coded("a.glsl", Group(coded("b.glsl", Group(coded("c.glsl")))), Group(coded("d.glsl"), path="look.json"))


def test_groups_are_searched_however_deep() -> None:
    found = [item.code.file for _, item in code_items(DEEP)]  # pyright: ignore[reportAttributeAccessIssue]
    assert sorted(found) == ["a.glsl", "b.glsl", "c.glsl", "d.glsl"]
    own = [item.code.file for _, item in code_items(DEEP, borrowed=False)]  # pyright: ignore[reportAttributeAccessIssue]
    assert sorted(own) == ["a.glsl", "b.glsl", "c.glsl"]


def test_texts_of_groups_from_files_are_not_written_back() -> None:
    assert {file.name: text[-6:] for file, text in file_texts(DEEP).items()} == {
        name: name for name in ("a.glsl", "b.glsl", "c.glsl")
    }
    assert all(isinstance(file, Path) for file in file_texts(DEEP))

"""The nodes of a graph and of its groups, however deep."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from halation.authoring.edits.coding import file_texts
from halation.custom_nodes import Code, node_type
from halation.graph import Graph, Group, Unknown
from halation.nodes import catalogue
from halation.watch.code_files import code_files, code_items


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


def test_files_of_code_lie_beside_the_graph_that_names_them(tmp_path: Path) -> None:
    """A node of ISF may have a vertex shader beside it; one whose code is broken has its file all the same."""
    inner = replace(coded("deep/b.glsl"), folder=str(tmp_path / "lib"))
    graph = replace(coded("a.glsl"), folder=str(tmp_path)).add("group", Group(inner, path="lib/body.json"))
    for name, raw in (
        ("gone", {"file": "gone.glsl"}), ("plain", {"code": "void"}), ("odd", {"file": 3}), ("empty", {"file": ""}),
    ):  # fmt: skip
        graph = graph.add(name, Unknown("glsl", raw))
    graph = graph.add("isf", Unknown("isf", {"file": "i.fs"})).add("no_code", Unknown("exposure", {"file": "x.exr"}))
    graph = graph.add("node", catalogue()["exposure"]()).add("again", Unknown("glsl", {"file": "a.glsl"}))
    names = ["a.glsl", "gone.glsl", "i.fs", "i.vs", "lib/deep/b.glsl"]
    assert sorted(code_files(graph)) == [tmp_path / name for name in names]


def test_only_code_of_isf_has_a_vertex_shader(tmp_path: Path) -> None:
    source = '/*{"INPUTS": []}*/\nvoid main() { gl_FragColor = vec4(1.0); }'
    graph = Graph(folder=str(tmp_path)).add("isf", node_type(Code("isf", source, "own.fs"))())
    assert code_files(graph) == (tmp_path / "own.fs", tmp_path / "own.vs")
    assert code_files(replace(coded("own.fs"), folder=str(tmp_path))) == (tmp_path / "own.fs",)

"""Code in documents: in the graph, or in a file beside it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from halation import document
from halation.custom_nodes import CustomNode
from halation.document import FORMAT
from halation.errors import DocumentError
from halation.graph import Graph, Unknown, problems
from halation.resources.sandbox import UNRESTRICTED
from hypothesis import given
from hypothesis import strategies as some

TEXT = "vec4 tint(vec4 image, float k /* = 0.5 */) {\n    return image * k;\n}"


def written(graph: Graph, id: str = "tint") -> CustomNode:
    item = graph.nodes[id]
    assert isinstance(item, CustomNode)
    return item


def raw(**node: Any) -> str:
    import json

    return json.dumps({"halation": FORMAT, "nodes": {"tint": {"type": "glsl", **node}}})


def test_code_stands_line_by_line() -> None:
    text = document.dumps(document.loads(raw(code=TEXT.split("\n"), values={"k": 0.25}), sandbox=UNRESTRICTED))
    assert '\n        "    return image * k;",\n' in text and '"values": {"k": 0.25}' in text
    again = document.loads(text, sandbox=UNRESTRICTED)
    assert written(again).code.text == TEXT and document.dumps(again) == text


def test_a_file_beside_the_graph(tmp_path: Path) -> None:
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "tint.glsl").write_text(TEXT)
    (tmp_path / "graph.json").write_text(raw(file="code/tint.glsl", values={"k": 2.0}))
    graph = document.load(tmp_path / "graph.json", sandbox=UNRESTRICTED)
    assert getattr(written(graph), "k") == 2.0 and written(graph).code.file == "code/tint.glsl"  # noqa: B009
    assert '"file": "code/tint.glsl"' in document.dumps(graph) and "return" not in document.dumps(graph)


def test_a_file_that_is_not_there_is_a_problem(tmp_path: Path) -> None:
    (tmp_path / "graph.json").write_text(raw(file="none.glsl"))
    graph = document.load(tmp_path / "graph.json", sandbox=UNRESTRICTED)
    assert isinstance(graph.nodes["tint"], Unknown)
    assert [p.sentence for p in problems(graph) if p.severity == "error"] == [
        f"node 'tint': {tmp_path / 'none.glsl'}: there is no such file"
    ]
    assert '"file": "none.glsl"' in document.dumps(graph)


@pytest.mark.parametrize("node", [{}, {"code": ["a"], "file": "b"}, {"code": "text"}, {"code": [1]}, {"file": 3}])
def test_what_is_no_code_is_refused(node: dict[str, Any]) -> None:
    with pytest.raises(DocumentError, match=r"nodes\.tint"):
        document.loads(raw(**node), sandbox=UNRESTRICTED)


def test_values_are_checked_by_type() -> None:
    with pytest.raises(DocumentError, match=r"nodes\.tint\.values\.k: expected a number"):
        document.loads(raw(code=TEXT.split("\n"), values={"k": "much"}), sandbox=UNRESTRICTED)


@given(some.lists(some.text(some.characters(exclude_categories=["Cs"]), max_size=40), max_size=12))
def test_any_lines_come_back(lines: list[str]) -> None:
    graph = document.loads(raw(code=lines), sandbox=UNRESTRICTED)
    assert document.loads(document.dumps(graph), sandbox=UNRESTRICTED) == graph

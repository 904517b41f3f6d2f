"""Paths of files when graphs move, and when what they refer to moves into them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from halation import document
from halation.compiler.lowering.references import find_path_texts
from halation.graph.paths import change_paths, inline_files, rebase_paths
from halation.resources.sandbox import UNRESTRICTED

INNER = {
    "halation": 1,
    "outputs": {"image": {"type": "Image"}},
    "controls": {"file": {"target": "read.path"}},
    "nodes": {"read": {"type": "read_image", "values": {"path": "dust.exr"}}},
    "links": {"outputs.image": "read.out"},
}
OUTER = {
    "halation": 1,
    "outputs": {"image": {"type": "Image"}},
    "controls": {"file": {"target": "in.file"}},
    "nodes": {"in": {"type": "group", "path": "deep/inner.json", "values": {"file": "snow.exr"}}},
    "links": {"outputs.image": "in.image"},
}


def top(**values: str) -> dict[str, object]:
    return {
        "halation": 1,
        "outputs": {"image": {"type": "Image"}},
        "inputs": {"plate": {"type": "Image", "file": "plate.exr"}},
        "nodes": {"out": {"type": "group", "path": "library/outer.json", **({"values": values} if values else {})}},
        "links": {"outputs.image": "out.image"},
    }


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "library" / "deep").mkdir(parents=True)
    (tmp_path / "library" / "deep" / "inner.json").write_text(json.dumps(INNER))
    (tmp_path / "library" / "outer.json").write_text(json.dumps(OUTER))
    (tmp_path / "whole.json").write_text(json.dumps(top()))
    (tmp_path / "turned.json").write_text(json.dumps(top(file="../rain.exr")))
    return tmp_path


def files(graph) -> dict[str, str]:
    return {owner: str(Path(path).resolve()) for owner, (_, path) in find_path_texts(graph).items()}


@pytest.mark.parametrize("name", ["whole", "turned"])
def test_what_is_inside_leads_to_the_same_files(folder: Path, name: str) -> None:
    """Two files of groups in two folders, and a control that reaches through both."""
    graph = document.load(folder / f"{name}.json", sandbox=UNRESTRICTED)
    whole = inline_files(graph)
    assert files(whole) == files(graph) and len(files(graph)) == 2
    text = document.dumps(whole)
    assert "inner.json" not in text and "outer.json" not in text
    (folder / "library").rename(folder / "gone")
    again = document.loads(text, folder=str(folder), sandbox=UNRESTRICTED)
    assert files(again) == files(whole)


def test_a_graph_that_moves_takes_its_paths_along(folder: Path, tmp_path: Path) -> None:
    graph = inline_files(document.load(folder / "whole.json", sandbox=UNRESTRICTED))
    moved = rebase_paths(graph, str(tmp_path / "library" / "deep"))
    assert files(moved) == files(graph) and find_path_texts(moved)["inputs.plate"][0] == "../../plate.exr"
    assert rebase_paths(moved, str(folder)) == graph


def test_every_path_can_be_another(folder: Path) -> None:
    graph = inline_files(document.load(folder / "turned.json", sandbox=UNRESTRICTED))
    changed = change_paths(graph, lambda path: f"x/{Path(path).name}")
    assert {text for text, _ in find_path_texts(changed).values()} == {"x/plate.exr", "x/rain.exr"}


def test_code_comes_inside(tmp_path: Path) -> None:
    (tmp_path / "twice.glsl").write_text("vec4 twice(vec4 image) { return image * 2.0; }\n")
    (tmp_path / "graph.json").write_text(
        json.dumps(
            {
                "halation": 1,
                "nodes": {"code": {"type": "glsl", "file": "twice.glsl"}},
            }
        )
    )
    whole = inline_files(document.load(tmp_path / "graph.json", sandbox=UNRESTRICTED))
    (tmp_path / "twice.glsl").unlink()
    assert (
        "image * 2.0" in document.dumps(whole) and document.loads(document.dumps(whole), sandbox=UNRESTRICTED) == whole
    )

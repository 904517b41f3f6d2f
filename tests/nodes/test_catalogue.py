"""What every node promises, whoever wrote it."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest
from halation.compiler import load_library
from halation.nodes import Filter, Kind, Node, Pointwise, built_in_nodes
from halation.regression.node_promises import (
    TRIALS,
    can_be_tried,
    find_changing_values,
    find_declaration_faults,
    find_file_faults,
    find_shader_faults,
)

ROOT = Path(__file__).parents[2]
NODES = list(built_in_nodes().values())
RENDERED = [node for node in NODES if can_be_tried(node)]
CUBE = str(ROOT / "tests/data/warm.cube")

by_id = pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)
rendered = pytest.mark.parametrize("node", RENDERED, ids=lambda node: node.id)


def shader(node: type[Node]) -> Path:
    return ROOT / "shaders" / node.category / f"{node.id}.glsl"


@by_id
def test_it_explains_itself(node):
    assert [*find_declaration_faults(node)] == []


@by_id
def test_file_name_is_id_is_shader_name(node):
    path = Path(inspect.getfile(node))
    assert path == ROOT / "nodes" / node.category / f"{node.id}.py"
    assert node.__doc__ and len([item for item in NODES if item.id == node.id]) == 1
    if issubclass(node, Pointwise):
        assert shader(node).is_file()


@pytest.mark.parametrize("node", [node for node in NODES if issubclass(node, Pointwise)], ids=lambda node: node.id)
def test_the_glsl_signature_is_the_declaration(node):
    assert [*find_shader_faults(node)] == []


SHADERS = sorted(name for name in load_library().texts if not name.startswith("viewer/"))
"""What passes are made of. The viewer's are whole programs, which never meet a node's."""


@pytest.mark.parametrize("name", SHADERS)
def test_shader_names_do_not_clash(name):
    """Nothing is called like a GLSL word, and a node's helpers start with its id, so that any two nodes can fuse."""
    assert [*find_file_faults(name, SHADERS)] == []
    for function in load_library().texts[name].all_functions:
        if not name.startswith(("lib/", "primitive/")):
            id = name.rpartition("/")[2]
            assert re.match(rf"{id}(_|$)", function.name), f"call '{function.name}' '{id}_{function.name}'"


@pytest.mark.parametrize("name", SHADERS)
def test_every_shader_belongs_to_a_node(name):
    folder, _, id = name.partition("/")
    assert folder in ("lib", "primitive") or (id in built_in_nodes() and built_in_nodes()[id].category == folder)
    source = re.sub(r"//[^\n]*", "", (ROOT / "shaders" / f"{name}.glsl").read_text(encoding="utf-8"))
    for word in ("#version", "void main", "uniform ", "texture(", "imageLoad"):
        assert word not in source
    assert "fract(sin(" not in source.replace(" ", "")


@rendered
@pytest.mark.parametrize("trial", TRIALS)
def test_its_pixels_are_sound(renderer, node, trial):
    """At any size, with NaN and infinity in its pictures, with every choice, and where pixels are half covered."""
    assert [*TRIALS[trial](renderer, node, CUBE)] == []


@rendered
def test_some_values_change_the_picture(node):
    """The trials need them: a node that is taken for a neutral one is not drawn. A switch changes nothing."""
    passed_on = node(**find_changing_values(node, CUBE)).identity()
    assert passed_on == ("a" if node.id == "select" else None)


def test_the_vocabulary_is_used():
    assert {issubclass(node, Pointwise) or issubclass(node, Filter) for node in NODES} == {True}
    assert {output.socket.kind for node in NODES for output in node.outputs.values()} >= {
        Kind.IMAGE,
        Kind.FIELD,
        Kind.VECTOR,
        Kind.NUMBER,
    }

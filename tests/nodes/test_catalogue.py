"""What every node promises, whoever wrote it."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import graph_of
from halation.compiler import installed_library
from halation.graph import Graph, Port
from halation.nodes import Filter, Kind, Node, Pointwise, Source, Trait, built_in_nodes, look_at
from halation.renderer import RenderRequest

ROOT = Path(__file__).parents[2]
NODES = list(built_in_nodes().values())
RENDERED = [
    node
    for node in NODES
    if not issubclass(node, Source) and any(output.socket.kind is not Kind.CAMERA for output in node.outputs.values())
]

GLSL_WORDS = frozenset(
    (
        "abs",
        "acos",
        "acosh",
        "active",
        "all",
        "any",
        "asin",
        "asinh",
        "atan",
        "atanh",
        "atomicAdd",
        "attribute",
        "barrier",
        "bitCount",
        "bitfieldExtract",
        "bitfieldInsert",
        "bitfieldReverse",
        "buffer",
        "case",
        "ceil",
        "centroid",
        "clamp",
        "common",
        "cos",
        "cosh",
        "cross",
        "dFdx",
        "dFdy",
        "default",
        "degrees",
        "determinant",
        "discard",
        "distance",
        "dot",
        "equal",
        "exp",
        "exp2",
        "faceforward",
        "filter",
        "findLSB",
        "findMSB",
        "fixed",
        "flat",
        "floatBitsToInt",
        "floatBitsToUint",
        "floor",
        "fma",
        "fract",
        "frexp",
        "fwidth",
        "greaterThan",
        "greaterThanEqual",
        "half",
        "imageLoad",
        "imageSize",
        "imageStore",
        "input",
        "intBitsToFloat",
        "invariant",
        "inverse",
        "inversesqrt",
        "isinf",
        "isnan",
        "ldexp",
        "length",
        "lessThan",
        "lessThanEqual",
        "log",
        "log2",
        "main",
        "matrixCompMult",
        "max",
        "min",
        "mix",
        "mod",
        "modf",
        "noise1",
        "noise2",
        "noise3",
        "noise4",
        "normalize",
        "not",
        "notEqual",
        "outerProduct",
        "output",
        "partition",
        "patch",
        "pow",
        "precise",
        "radians",
        "reflect",
        "refract",
        "resource",
        "round",
        "roundEven",
        "sample",
        "shared",
        "sign",
        "sin",
        "sinh",
        "smooth",
        "smoothstep",
        "sqrt",
        "step",
        "struct",
        "switch",
        "tan",
        "tanh",
        "template",
        "texelFetch",
        "texture",
        "textureGather",
        "textureGrad",
        "textureLod",
        "textureSize",
        "this",
        "transpose",
        "trunc",
        "uintBitsToFloat",
        "uniform",
        "varying",
    )
)

by_id = pytest.mark.parametrize("node", NODES, ids=lambda node: node.id)
rendered = pytest.mark.parametrize("node", RENDERED, ids=lambda node: node.id)


def shader(node: type[Node]) -> Path:
    return ROOT / "shaders" / node.category / f"{node.id}.glsl"


@by_id
def test_it_explains_itself(node):
    doc = inspect.getdoc(node)
    assert doc and doc != inspect.getdoc(node.__mro__[1]), "a docstring is the tooltip"
    assert doc.splitlines()[0].endswith("."), "its first line is a sentence"
    for value in node.values.values():
        if value.type in ("float", "int"):
            assert value.unit, f"'{value.name}' has no unit"
            assert value.minimum <= value.low < value.high <= value.maximum, f"'{value.name}' has a strange range"
            assert value.minimum <= value.default <= value.maximum, f"the default of '{value.name}' is out of range"
        if value.type == "choice":
            assert value.default in value.choices
        if value.layer_by:
            assert value.layer_by in node.values
        if value.file:
            assert node.values[value.file].holds == "render" and value.type in ("text", "choice")
            assert not value.matte or value.matte in node.values


@by_id
def test_file_name_is_id_is_shader_name(node):
    path = Path(inspect.getfile(node))
    assert path == ROOT / "nodes" / node.category / f"{node.id}.py"
    assert node.__doc__ and len([item for item in NODES if item.id == node.id]) == 1
    if issubclass(node, Pointwise):
        assert shader(node).is_file()


@pytest.mark.parametrize("node", [node for node in NODES if issubclass(node, Pointwise)], ids=lambda node: node.id)
def test_the_glsl_signature_is_the_declaration(node):
    function = installed_library().function(f"{node.category}/{node.id}", node.id, node.id)
    declared = tuple(
        (node.inputs[name].glsl if name in node.inputs else node.values[name].glsl, name)
        for name in node.order
        if name in node.inputs or node.values[name].glsl
    )
    assert tuple((glsl, name) for glsl, name in function.parameters) == declared
    outputs = [output.socket.glsl for output in node.outputs.values()]
    if len(outputs) == 1:
        assert (function.result, function.outputs) == (outputs[0], ())
    else:
        assert function.result == "void"
        assert [glsl for glsl, _ in function.outputs] == outputs


def face(function) -> tuple[str, tuple[str, ...]]:
    """What GLSL tells functions apart by."""
    return function.name, tuple(glsl for glsl, _ in (*function.parameters, *function.outputs))


SHADERS = sorted(name for name in installed_library().texts if not name.startswith("viewer/"))
"""What passes are made of. The viewer's are whole programs, which never meet a node's."""


@pytest.mark.parametrize("name", SHADERS)
def test_shader_names_do_not_clash(name):
    """Nothing is called like a GLSL word, and a node's helpers start with its id, so that any two nodes can fuse."""
    text = installed_library().texts[name]
    taken = {
        face(one) for other, item in installed_library().texts.items() if other != name for one in item.all_functions
    }
    for function in text.all_functions:
        assert function.name not in GLSL_WORDS
        assert face(function) not in taken, f"'{function.name}' is defined in another file too"
        assert not {parameter for _, parameter in function.parameters} & GLSL_WORDS
        assert not {parameter for _, parameter in function.parameters} & {"pixel", "extent", "proxy", "frame"}
        if not name.startswith(("lib/", "primitive/")):
            assert re.match(rf"{name.rpartition('/')[2]}(_|$)", function.name), function.name


@pytest.mark.parametrize("name", SHADERS)
def test_every_shader_belongs_to_a_node(name):
    folder, _, id = name.partition("/")
    assert folder in ("lib", "primitive") or (id in built_in_nodes() and built_in_nodes()[id].category == folder)
    source = re.sub(r"//[^\n]*", "", (ROOT / "shaders" / f"{name}.glsl").read_text(encoding="utf-8"))
    for word in ("#version", "void main", "uniform ", "texture(", "imageLoad"):
        assert word not in source
    assert "fract(sin(" not in source.replace(" ", "")


def picture(node: type[Node], name: str, size: tuple[int, int], rng: np.random.Generator) -> np.ndarray:
    width, height = size
    return rng.gamma(0.7, 1.0, (height, width, node.inputs[name].channels)).astype(np.float32)


def fed(node: Node, arrays: dict[str, np.ndarray]) -> Graph:
    """A graph of one node with these pictures, and a camera wherever one is taken."""
    camera = look_at((0.0, -5.0, 1.5), (0.0, 0.0, 1.0), (1.4, 2.5))
    cameras = {name: camera for name, socket in type(node).inputs.items() if socket.kind is Kind.CAMERA}
    return graph_of(node, arrays | cameras)


def outputs_of(renderer, node: type[Node], arrays, **options):
    targets = {name: Port("node", name) for name in node.outputs}
    return renderer.render(fed(node(), arrays), RenderRequest(arrays, targets, precision="float", **options))


def recolors_one_picture(node: type[Node]) -> bool:
    """True for a pointwise node that changes the color of its only picture, whatever its coverage."""
    images = [socket for socket in node.inputs.values() if socket.kind is Kind.IMAGE]
    gives_picture = any(output.socket.kind is Kind.IMAGE for output in node.outputs.values())
    return issubclass(node, Pointwise) and len(images) == 1 and gives_picture and Trait.USES_ALPHA not in node.traits


@rendered
@pytest.mark.parametrize("size", [(1, 1), (2, 3), (17, 11), (64, 1), (1, 63)], ids=str)
def test_it_renders_finite_at_defaults(renderer, node, size):
    rng = np.random.default_rng(5)
    arrays = {
        name: picture(node, name, size, rng) if not socket.single else np.full((1, 1), 0.4, np.float32)
        for name, socket in node.inputs.items()
        if socket.kind is not Kind.CAMERA
    }
    found = outputs_of(renderer, node, arrays, **({} if arrays else {"size": size}))
    for name, output in node.outputs.items():
        width, height = (1, 1) if output.socket.single else size
        assert found[name].shape == (height, width, output.socket.channels)
        assert np.isfinite(found[name]).all(), name


@rendered
def test_nothing_that_is_no_number_comes_out(renderer, node):
    """NaN and infinity in a picture neither come out nor spread; data that passes through a wire stays as it is."""
    size = (23, 19)
    rng = np.random.default_rng(6)
    arrays = {name: picture(node, name, size, rng) for name, socket in node.inputs.items() if not socket.single}
    if not arrays:
        pytest.skip("it has no picture to spoil")
    if Trait.KEEPS_NON_FINITE in node.traits:
        pytest.skip("it passes its inputs on as they are")
    for array in arrays.values():
        array[3, 4] = np.nan
        array[8, 15] = np.inf
        array[11, 2] = -np.inf
        array[12, 12] = -5.0
        array[0, 0, 0] = np.nan
        array[18, 22] = 3e38
    changed = node(**neutral_off(node))
    graph = fed(changed, arrays)
    targets = {name: Port("node", name) for name in node.outputs}
    found = renderer.render(graph, RenderRequest(arrays, targets, precision="float"))
    for name in node.outputs:
        assert np.isfinite(found[name]).all(), name


@pytest.mark.parametrize("node", [node for node in RENDERED if recolors_one_picture(node)], ids=lambda node: node.id)
def test_half_coverage_gives_half_of_the_color(renderer, node):
    """Pictures are premultiplied: an edge must not become another color than the area that it bounds."""
    rng = np.random.default_rng(8)
    (image,) = (name for name, socket in node.inputs.items() if socket.kind is Kind.IMAGE)
    arrays = {
        name: np.full((1, 1), 0.4, np.float32) if socket.single else picture(node, name, (16, 12), rng)
        for name, socket in node.inputs.items()
        if socket.kind is not Kind.CAMERA
    }
    arrays[image][..., 3] = 1.0
    halves = arrays | {image: 0.5 * arrays[image]}
    targets = {name: Port("node", name) for name, output in node.outputs.items() if output.socket.kind is Kind.IMAGE}
    for values in ({}, neutral_off(node)):
        covered, half = (
            renderer.render(fed(node(**values), pictures), RenderRequest(pictures, targets, precision="float"))
            for pictures in (arrays, halves)
        )
        for name in targets:
            np.testing.assert_allclose(2.0 * half[name], covered[name], rtol=1e-3, atol=1e-3, err_msg=name)


def neutral_off(node: type[Node]) -> dict[str, object]:
    """Values that keep a node from being taken for a neutral one."""
    if node().identity() is None:
        return {}
    for value in node.values.values():
        if value.type == "float":
            for tried in (value.high, value.low, (value.low + value.high) / 2):
                if node(**{value.name: tried}).identity() is None:
                    return {value.name: tried}
        for choice in value.choices:
            if node(**{value.name: choice}).identity() is None:
                return {value.name: choice}
        if value.type in ("color", "vector"):
            return {value.name: tuple(part + 0.1 for part in value.default)}
        if value.type == "curve":
            return {value.name: (0.0, 0.1, 0.3, 0.6, 1.0, 0.9)}
        if value.type == "path":
            return {value.name: str(ROOT / "tests/data/warm.cube")}
    raise AssertionError(f"{node.id} is neutral whatever its values are")


@rendered
def test_its_choices_all_compile(renderer, node):
    rng = np.random.default_rng(7)
    arrays = {name: picture(node, name, (9, 7), rng) for name, socket in node.inputs.items() if not socket.single}
    targets = {name: Port("node", name) for name in node.outputs}
    for value in node.values.values():
        for choice in value.choices[1:]:
            graph = fed(node(**{value.name: choice}), arrays)
            found = renderer.render(graph, RenderRequest(arrays, targets, (9, 7), precision="float"))
            for name, array in found.items():
                assert np.isfinite(array).all(), (value.name, choice, name)


def test_the_vocabulary_is_used():
    assert {issubclass(node, Pointwise) or issubclass(node, Filter) for node in NODES} == {True}
    assert {output.socket.kind for node in NODES for output in node.outputs.values()} >= {
        Kind.IMAGE,
        Kind.FIELD,
        Kind.VECTOR,
        Kind.NUMBER,
    }

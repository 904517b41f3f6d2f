"""The promises of every node, which `halation nodes --check` and the tests of all nodes check.

Each function yields sentences about what is wrong, none for a node that keeps its promises: its class explains itself
and has sound ranges, its shader fits the class and compiles, and its pixels are finite whatever comes in.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from halation.nodes import Kind, Node, Pointwise, Source, Trait, Value, find_fault_place, look_at

from ..compiler import load_library
from ..errors import HalationError, ShaderError
from ..glsl.taken_names import TAKEN_NAMES
from ..graph import Graph, Input, Output, Port

if TYPE_CHECKING:
    from ..compiler import Library
    from ..glsl.text import GlslFunction
    from ..renderer import Renderer, RenderRequest

Pictures = dict[str, np.ndarray]

_PASS_NAMES = frozenset({"pixel", "extent", "proxy", "frame"})
"""Names that every pass declares."""

_PASS_TEXT = ("#version", "void main", "uniform ", "texture(", "imageLoad")
"""Text that the compiler writes around the functions of a node, and instead of a call that reads a picture."""


def find_declaration_faults(node: type[Node]) -> Iterator[str]:
    """Faults of the class: its tooltip, units, ranges and choices."""
    doc = inspect.getdoc(node)
    is_generated = (doc or "").startswith(f"{node.__name__}(")  # a dataclass without a docstring describes its fields
    if not doc or is_generated or doc == inspect.getdoc(node.__mro__[1]):
        yield "its class has no docstring, which is the tooltip"
    elif not doc.splitlines()[0].endswith("."):
        yield "the first line of its docstring is no sentence: it does not end in '.'"
    for value in node.values.values():
        yield from (f"the value '{value.name}' {fault}" for fault in _find_value_faults(node, value))


def _find_value_faults(node: type[Node], value: Value) -> Iterator[str]:
    if value.type in ("float", "int"):
        if not value.unit:
            yield "has no unit: annotate it with a Slider"
        elif not value.minimum <= value.low < value.high <= value.maximum:
            yield f"has a slider from {value.low:g} to {value.high:g}, which its hard range does not hold"
        if not value.minimum <= value.default <= value.maximum:  # type: ignore[operator]
            yield f"has the default {value.default}, which its hard range does not hold"
    if value.type == "choice" and value.default not in value.choices:
        yield f"has the default '{value.default}', which is none of its choices"
    for name in filter(None, (value.layer_by, value.file, value.matte)):
        if name not in node.values:
            yield f"names the value '{name}', which the class does not have"
    if value.file in node.values and (
        node.values[value.file].holds != "render" or value.type not in ("text", "choice")
    ):
        yield f"picks a layer of '{value.file}', which must be the path of a render"


def find_shader_faults(node: type[Node]) -> Iterator[str]:
    """How the shader of a pointwise node differs from what its class declares."""
    if not issubclass(node, Pointwise):
        return
    try:
        function = load_library().function(node.shader, node.function, node.id)
    except ShaderError as fault:
        yield fault.sentence
        return
    declared = tuple(
        (node.inputs[name].glsl if name in node.inputs else node.values[name].glsl, name)
        for name in node.order
        if name in node.inputs or node.values[name].glsl
    )
    outputs = tuple(output.socket.glsl for output in node.outputs.values())
    result, results = (outputs[0], ()) if len(outputs) == 1 else ("void", outputs)
    if (
        function.parameters != declared
        or function.result != result
        or tuple(type for type, _ in function.outputs) != results
    ):
        parameters = [f"{type} {name}" for type, name in declared]
        parameters += [f"out {type} {name}" for type, name in zip(results, node.outputs, strict=False)]
        declaration = f"{result} {node.function}({', '.join(parameters)})"
        yield f"its shader does not fit the class, which needs: {declaration}"


def find_file_faults(name: str, names: Iterable[str]) -> Iterator[str]:
    """Faults of a shader file: names that clash, includes of no file, text that only the compiler may write.

    `names` are the files whose functions may be in one program with its own.
    """
    library = load_library()
    try:
        text = library.texts[name]
        library.closure((name,), name)
    except ShaderError as fault:
        yield fault.sentence
        return
    others = {signature for other in names if other != name for signature in _list_signatures(library, other)}
    for function in text.all_functions:
        place = f"{text.file}, line {function.line}: "
        if function.name in TAKEN_NAMES:
            yield f"{place}the function '{function.name}' has a name that GLSL reserves: choose another one"
        if _signature(function) in others:
            yield f"{place}the function '{function.name}' is defined in another file too: rename one"
        for _, parameter in function.parameters:
            if parameter in TAKEN_NAMES | _PASS_NAMES:
                yield f"{place}the parameter '{parameter}' has a name that GLSL or the pass reserves: choose another"
    for word in _PASS_TEXT:
        if re.search(rf"(?<![\w]){re.escape(word)}", text.body):
            yield f"{text.file}: '{word.strip()}' is written by the compiler: leave it out"


def _list_signatures(library: Library, name: str) -> list[tuple[str, tuple[str, ...]]]:
    """The signatures of all functions of a file; none of one that cannot be read, whose fault is its own."""
    try:
        return [_signature(function) for function in library.texts[name].all_functions]
    except ShaderError:
        return []


def _signature(function: GlslFunction) -> tuple[str, tuple[str, ...]]:
    """The part of a signature by which GLSL distinguishes functions."""
    return function.name, tuple(type for type, _ in (*function.parameters, *function.outputs))


def can_be_tried(node: type[Node]) -> bool:
    """True for a node that makes pixels of pictures alone, so that it can be rendered without files."""
    return not issubclass(node, Source) and any(not output.socket.kind.is_planned for output in node.outputs.values())


def _try_sizes(renderer: Renderer, node: type[Node], _: str) -> Iterator[str]:
    for width, height in ((1, 1), (2, 3), (17, 11), (64, 1), (1, 63)):  # smaller than most reaches; primes; lines
        pictures = make_pictures(node, (width, height), np.random.default_rng(5))
        size = None if pictures else (width, height)
        across, down = node().output_size(dict.fromkeys(pictures, (width, height)), (width, height))
        if pictures and (width, height) == (1, 1):
            across, down = 1, 1  # a picture of one pixel is a constant, which stays one
        for name, picture in render_node(renderer, node(), pictures, size).items():
            socket = node.outputs[name].socket
            shape = (1, 1, socket.channels) if socket.single else (down, across, socket.channels)
            if picture.shape != shape:
                yield f"the output '{name}' has the shape {picture.shape} in place of {shape}"
            if not np.isfinite(picture).all():
                yield f"the output '{name}' has NaN or infinity at {width}x{height}, at the defaults"


def _try_bad_pixels(renderer: Renderer, node: type[Node], table: str) -> Iterator[str]:
    pictures = make_pictures(node, (23, 19), np.random.default_rng(6), single=False)
    if not pictures or Trait.KEEPS_NON_FINITE in node.traits:
        return
    for picture in pictures.values():
        picture[3, 4] = np.nan
        picture[8, 15] = np.inf
        picture[11, 2] = -np.inf
        picture[12, 12] = -5.0
        picture[0, 0, 0] = np.nan
        picture[18, 22] = 3e38
    for name, picture in render_node(renderer, node(**find_changing_values(node, table)), pictures).items():
        if not np.isfinite(picture).all():
            yield f"NaN or infinity of a picture comes out at '{name}': use finite() of lib/finite.glsl"


def _try_choices(renderer: Renderer, node: type[Node], _: str) -> Iterator[str]:
    pictures = make_pictures(node, (9, 7), np.random.default_rng(7), single=False)
    for value in node.values.values():
        for choice in value.choices[1:]:
            subject = node().with_values(**{value.name: choice})
            for name, picture in render_node(renderer, subject, pictures, (9, 7)).items():
                if not np.isfinite(picture).all():
                    yield f"the output '{name}' has NaN or infinity with {value.name}={choice}"


def recolors_one_picture(node: type[Node]) -> bool:
    """True for a pointwise node that changes the color of its only picture, whatever its coverage."""
    images = [socket for socket in node.inputs.values() if socket.kind is Kind.IMAGE]
    gives_picture = any(output.socket.kind is Kind.IMAGE for output in node.outputs.values())
    return issubclass(node, Pointwise) and len(images) == 1 and gives_picture and Trait.USES_ALPHA not in node.traits


def _try_half_coverage(renderer: Renderer, node: type[Node], table: str) -> Iterator[str]:
    """Pictures are premultiplied: an edge must not become another color than the area that it bounds."""
    if not recolors_one_picture(node):
        return
    (image,) = (name for name, socket in node.inputs.items() if socket.kind is Kind.IMAGE)
    pictures = make_pictures(node, (16, 12), np.random.default_rng(8))
    pictures[image][..., 3] = 1.0
    halves = pictures | {image: 0.5 * pictures[image]}
    for values in ({}, find_changing_values(node, table)):
        covered, half = render_node(renderer, node(**values), pictures), render_node(renderer, node(**values), halves)
        for name in node.outputs:
            is_image = node.outputs[name].socket.kind is Kind.IMAGE
            if is_image and not np.allclose(2.0 * half[name], covered[name], rtol=1e-3, atol=1e-3):
                yield (
                    f"a half-covered pixel has another color at '{name}' than the same pixel fully covered: use "
                    "straight() and premultiplied() of lib/alpha.glsl, or declare Trait.USES_ALPHA"
                )
                return


def make_pictures(
    node: type[Node], size: tuple[int, int], rng: np.random.Generator, *, single: bool = True
) -> Pictures:
    """Random light for every input, and 0.4 for inputs of one pixel unless they are left out."""
    width, height = size
    return {
        name: np.full((1, 1), 0.4, np.float32)
        if socket.single
        else rng.gamma(0.7, 1.0, (height, width, socket.channels)).astype(np.float32)
        for name, socket in node.inputs.items()
        if not socket.kind.is_planned and not socket.folded and (single or not socket.single)
    }


def find_changing_values(node: type[Node], table: str = "") -> dict[str, Any]:
    """Values at which the node changes its picture; none if it does so at its defaults, or whatever they are."""
    if node().identity() is None:
        return {}
    candidates = (
        {value.name: candidate} for value in node.values.values() for candidate in _other_values(value, table)
    )
    return next((values for values in candidates if node(**values).identity() is None), {})


def _other_values(value: Value, table: str) -> tuple[Any, ...]:
    if value.type == "float":
        return value.high, value.low, (value.low + value.high) / 2
    if value.choices:
        return value.choices
    if value.type in ("color", "vector"):
        return (tuple(part + 0.1 for part in value.default),)  # type: ignore[union-attr]
    if value.type == "curve":
        return ((0.0, 0.1, 0.3, 0.6, 1.0, 0.9),)
    return (table,) if value.type == "path" and table else ()


def render_node(
    renderer: Renderer, node: Node, pictures: Mapping[str, np.ndarray], size: tuple[int, int] | None = None
) -> dict[str, np.ndarray]:
    """Every output of a node with these pictures, and a camera wherever one is taken."""
    return renderer.render(*make_node_request(node, pictures, size))


def make_node_request(
    node: Node, pictures: Mapping[str, np.ndarray], size: tuple[int, int] | None = None
) -> tuple[Graph, RenderRequest]:
    """A graph of a node alone, and a request for all that it makes of these pictures, and of a camera."""
    from ..renderer import RenderRequest

    graph = Graph().add("node", node)
    camera = look_at((0.0, -5.0, 1.5), (0.0, 0.0, 1.0), (1.4, 2.5))
    for name, socket in type(node).inputs.items():
        if socket.kind is Kind.CAMERA:
            graph = graph.add_input(name, Input(Kind.CAMERA, default=camera.rows))
        elif name in pictures:
            graph = graph.add_input(name, Input(socket.kind, socket.channels))
        else:
            continue
        graph = graph.connect(Port("inputs", name), Port("node", name))
    for name, output in type(node).outputs.items():
        graph = graph.add_output(name, Output(output.socket.kind, output.socket.channels))
        graph = graph.connect(Port("node", name), Port("outputs", name))
    targets = {name: Port("node", name) for name in type(node).outputs}
    return graph, RenderRequest(dict(pictures), targets, size, precision="float")


TRIALS: Mapping[str, Callable[[Renderer, type[Node], str], Iterator[str]]] = MappingProxyType(
    {
        "sizes": _try_sizes,
        "bad pixels": _try_bad_pixels,
        "choices": _try_choices,
        "half coverage": _try_half_coverage,
    }
)
"""Trials with the pixels of a node."""


def find_render_faults(renderer: Renderer, node: type[Node], table: str = "") -> Iterator[str]:
    """Faults of its pixels: sizes, NaN and infinity, choices, half-covered pixels.

    `table` is a file for values that are paths of color tables.
    """
    try:
        for trial in TRIALS.values() if can_be_tried(node) else ():
            yield from trial(renderer, node, table)
    except HalationError as fault:
        yield str(fault).removeprefix("node 'node': ")
    except Exception as fault:
        if not (place := find_fault_place(fault, node)):
            raise
        yield f"{place}: {type(fault).__name__}: {fault}"

"""A node made of GLSL: the last function of the text is the node, its signature declares sockets and values."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache
from hashlib import blake2b
from typing import Any, cast

from halation.nodes import Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, Pointwise, Socket, Value, Vector
from msgspec import Struct

from ..glsl import COMMENT, GlslFunction, blank_comments, macro_name, parse, unify_lines, words
from ..glsl.loops import guard_loops
from .code import Code, CodeFault, CustomNode, make_class
from .ending import add_ending
from .notes import ParameterNote, read_note
from .passes import PARAMETER, make_passes
from .prefixes import prefix_names
from .securing import check_length, expand_code, guard_code
from .values import make_value

_FORBIDDEN = re.compile(
    r"\b(main|uniform|layout|buffer|shared|discard|barrier|texelFetch|texture\w*|gl_\w+"
    r"|image(?:Load|Store|Atomic)\w*|atomic\w+|subroutine|halation_\w+)\b"
    r"|^[ \t]*#[ \t]*(version|extension|pragma|line)\b",
    re.MULTILINE,
)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_RESERVED = frozenset({"pixel", "extent", "frame", "proxy", "grid"})
"""Names that code can use without declaring them."""
MAX_CLASSES = 512
"""Classes of code that are kept, as many as programs: hours of typing in the editor."""


class _Parameter(Struct, frozen=True):
    """One parameter of the function: its type, its name, the line it stands in and what is said of it."""

    glsl: str
    name: str
    out: bool
    line: int
    note: ParameterNote


@lru_cache(MAX_CLASSES)
def make_glsl_class(code: Code) -> type[CustomNode]:
    """The class of the nodes that this code describes. Raises CodeFault.

    The code is parsed twice. The text as it was written has the comments that describe sockets and values; the expanded
    text, in which no macro can hide a word, is what is checked and compiled.
    """
    check_length(code.text)
    source = unify_lines(code.text)
    plain = blank_comments(source)
    text = parse("written", source, code.name)
    _check_words(plain)
    if not text.all_functions:
        raise CodeFault(1, "there is no function in it: write one, such as vec4 tint(vec4 image) { return image; }")
    entry = text.all_functions[-1]
    parameters = tuple(_read_parameters(source, plain, entry))
    _check_parameters(entry, parameters)
    inputs = {
        parameter.name: _make_socket(parameter)
        for parameter in parameters
        if not parameter.out and not parameter.note.default
    }
    values = {
        parameter.name: make_value(parameter.glsl, parameter.name, parameter.note, parameter.line)
        for parameter in parameters
        if not parameter.out and parameter.note.default
    }
    outputs = {parameter.name: OutputSocket(_make_socket(parameter)) for parameter in parameters if parameter.out}
    if not outputs:
        outputs = {"out": OutputSocket(_make_picture_socket(entry.result, ParameterNote(), entry.line, "the result"))}
    types = _list_types(inputs, values)
    expanded = expand_code(source, _list_macros(values), types, may_include=True)
    _check_words(expanded)
    functions = parse("written", expanded).all_functions
    _check_entry(entry, functions)
    reads_neighbors = bool(
        words(expanded) & {f"{name}_{way}" for name in inputs for way in ("at", "near", "size", "has")}
    )
    names = {function.name for function in functions}
    return _make_class(code, expanded, names, types, entry, parameters, inputs, values, outputs, reads_neighbors)


def _choose_edge(entry: GlslFunction, parameters: tuple[_Parameter, ...]) -> Edge:
    """What lies outside of all inputs. Raises CodeFault for notes that contradict each other."""
    edges = sorted({parameter.note.edge for parameter in parameters if parameter.note.edge})
    if len(edges) > 1:
        raise CodeFault(entry.line, f"the inputs have different edges ({', '.join(edges)}): choose one for all of them")
    return cast("Edge", edges[0]) if edges else "clamp"


def _make_class(
    code: Code,
    expanded: str,
    functions: Collection[str],
    types: Mapping[str, str],
    entry: GlslFunction,
    parameters: tuple[_Parameter, ...],
    inputs: Mapping[str, Socket],
    values: Mapping[str, Value],
    outputs: Mapping[str, OutputSocket],
    reads_neighbors: bool,
) -> type[CustomNode]:
    """The class of a node. Its GLSL gets a prefix made from its text, so that codes with functions of one name can
    fuse, and guards against loops and divisions that would stop the device.
    """
    source = unify_lines(code.text)
    digest = blake2b(f"{code.language}\0{source}".encode(), digest_size=4).hexdigest()
    prefix = f"w{digest}_"
    function = prefix + entry.name
    edge = _choose_edge(entry, parameters)
    renamed = prefix_names(expanded, functions, prefix)
    with_loop_guards = guard_loops(renamed)
    with_guards = guard_code(with_loop_guards, types)
    has_division_guards = with_guards != with_loop_guards
    renamed = add_ending(with_guards, entry, prefix) if with_loop_guards != renamed else with_guards
    if has_division_guards:
        renamed += '\n#include "lib/whole.glsl"\n'
    methods: dict[str, Any] = {"__doc__": _find_doc(source, entry)}
    if reads_neighbors:
        renamed += _write_entry_functions(function, parameters, inputs, values, outputs)

        def passes(self: Filter, draw: Draw) -> Mapping[str, Drawn]:
            return make_passes(self, draw, function, edge)

        methods["passes"] = passes
    elif len(results := [parameter for parameter in parameters if parameter.out]) == 1:
        renamed += _add_return(function, parameters, results[0])
        function += "_out"
    base = Filter if reads_neighbors else Pointwise
    order = (parameter.name for parameter in parameters if not parameter.out)
    node_class = make_class(code, entry.name, base, inputs, values, outputs, order, methods)
    name = f"written/{digest}"
    node_class.function, node_class.shader = function, name
    node_class.title = entry.name.replace("_", " ")
    node_class.text = parse(name, renamed, code.file or f"the code of '{entry.name}'")
    return node_class


def _check_words(code: str) -> None:
    """Raise CodeFault for a word that code of a user may not say."""
    if forbidden := _FORBIDDEN.search(code):
        forbidden_word = forbidden[1] or f"#{forbidden[2]}"
        line = code.count("\n", 0, forbidden.start()) + 1
        raise CodeFault(
            line, f"'{forbidden_word}' has no place here: pictures are parameters, read as image or image_at(pixel)"
        )


def _check_entry(entry: GlslFunction, functions: Sequence[GlslFunction]) -> None:
    """Raise CodeFault where macros or conditions make another signature than the one that the text shows."""
    same = functions and functions[-1].name == entry.name
    if not same or (functions[-1].parameters, functions[-1].outputs) != (entry.parameters, entry.outputs):
        raise CodeFault(entry.line, f"the signature of '{entry.name}' must not depend on macros or conditions")


def _list_macros(values: Mapping[str, Value]) -> dict[str, str]:
    """The macros of choices, such as MODE_ADD, with their numbers."""
    return {
        macro_name(value.name, choice): str(number)
        for value in values.values()
        if value.type == "choice"
        for number, choice in enumerate(value.choices)
    }


def _list_types(inputs: Mapping[str, Socket], values: Mapping[str, Value]) -> dict[str, str]:
    """The types of what code can use without declaring it; those of functions by their names and brackets."""
    types = {"pixel": "ivec2", "extent": "ivec2", "frame": "int", "proxy": "float"}
    for name in inputs:
        types |= {f"{name}_size": "ivec2", f"{name}_at()": "vec4", f"{name}_near()": "vec4", f"{name}_has()": "bool"}
    return types | {name: value.glsl for name, value in values.items() if value.glsl}


def _read_parameters(source: str, plain: str, entry: GlslFunction) -> Iterator[_Parameter]:
    """The parameters of the function in order, each with the comments that stand beside it."""
    opening = plain.index("(", entry.start)
    closing = plain.index(")", opening)
    starts = [opening + 1, *(at + 1 for at in range(opening, closing) if plain[at] == ",")]
    if not plain[opening + 1 : closing].strip() or plain[opening + 1 : closing].strip() == "void":
        return
    for number, begin in enumerate(starts):
        is_last = number + 1 == len(starts)
        end = closing if is_last else starts[number + 1] - 1
        declaration = plain[begin:end].split()
        first = begin + len(plain[begin:end]) - len(plain[begin:end].lstrip())
        line = plain.count("\n", 0, first) + 1
        words = [word for word in declaration if word not in ("in", "const", "highp", "mediump", "lowp")]
        out = bool(words) and words[0] == "out"
        words = words[1:] if out else words
        if len(words) != 2 or not _NAME.fullmatch(words[1]):
            raise CodeFault(
                line, f"'{' '.join(declaration)}' is no parameter that a node can have: write a type and a name"
            )
        stop = source.find("\n", end)
        comment_after = COMMENT.search(source, end, len(source) if stop < 0 else stop)
        comment_inside = COMMENT.search(source, first, end)
        comment = comment_inside or (
            comment_after if comment_after and not plain[end + 1 : comment_after.start()].strip(" \t){") else None
        )
        yield _Parameter(words[0], words[1], out, line, read_note(comment[0], line) if comment else ParameterNote())


def _check_parameters(entry: GlslFunction, parameters: tuple[_Parameter, ...]) -> None:
    names = set[str]()
    for parameter in parameters:
        if parameter.name in names or parameter.name in _RESERVED:
            why = "is used twice" if parameter.name in names else "means something else here"
            raise CodeFault(parameter.line, f"the name '{parameter.name}' {why}: choose another")
        names.add(parameter.name)
    outputs = [parameter for parameter in parameters if parameter.out]
    if outputs and entry.result != "void":
        raise CodeFault(entry.line, f"'{entry.name}' returns a {entry.result} and has out parameters: keep one of both")
    if outputs and parameters[-len(outputs) :] != tuple(outputs):
        raise CodeFault(outputs[0].line, "put out parameters last")
    if not outputs and entry.result == "void":
        raise CodeFault(entry.line, f"'{entry.name}' makes nothing: return a vec4, or write an out parameter")


def _make_socket(parameter: _Parameter) -> Socket:
    return _make_picture_socket(parameter.glsl, parameter.note, parameter.line, f"'{parameter.name}'")


def _make_picture_socket(glsl: str, note: ParameterNote, line: int, subject: str) -> Socket:
    """What a picture of this GLSL type is to links."""
    if glsl == "vec4" and not note.vector:
        return Image(note.optional, doc=note.doc)
    if glsl == "float":
        return Field(note.optional, doc=note.doc)
    if glsl in ("vec2", "vec3", "vec4"):
        return Vector(note.optional, width=int(glsl[-1]), doc=note.doc)
    if glsl in ("int", "bool"):
        raise CodeFault(line, f"{subject} is a {glsl}, which no picture holds: give it a default, such as // = 1")
    raise CodeFault(line, f"{subject} has the type {glsl}: pictures are vec4, vec3, vec2 or float")


def _find_doc(source: str, entry: GlslFunction) -> str:
    """The comment right above the function, else a sentence."""
    lines = source.split("\n")[: entry.line - 1]
    doc_lines: list[str] = []
    while lines and lines[-1].strip().startswith("//"):
        doc_lines.insert(0, lines.pop().strip().lstrip("/").strip())
    if not doc_lines and lines and lines[-1].strip().endswith("*/"):
        block = "\n".join(lines)
        start = block.rfind("/*")
        doc_lines = [line.strip(" *\t") for line in block[start + 2 : -2].split("\n")] if start >= 0 else []
    return "\n".join(doc_lines).strip() or "Code of this graph."


def _add_return(function: str, parameters: tuple[_Parameter, ...], result: _Parameter) -> str:
    """A function that returns the only output, which pointwise nodes need."""
    declarations = ", ".join(
        f"{parameter.glsl} {PARAMETER}{parameter.name}" for parameter in parameters if not parameter.out
    )
    arguments = ", ".join(f"{PARAMETER}{parameter.name}" for parameter in parameters)
    local = f"{PARAMETER}{result.name}"
    call = f"{function}({arguments})"
    return f"\n{result.glsl} {function}_out({declarations}) {{ {result.glsl} {local}; {call}; return {local}; }}\n"


def _write_entry_functions(
    function: str,
    parameters: tuple[_Parameter, ...],
    inputs: Mapping[str, Socket],
    values: Mapping[str, Value],
    outputs: Mapping[str, OutputSocket],
) -> str:
    """For each output a function that is drawn: it reads its own pixel of every picture and calls the user's."""
    value_list = ", ".join(
        f"{values[parameter.name].glsl} {PARAMETER}{parameter.name}"
        for parameter in parameters
        if parameter.name in values
    )
    argument_list = [
        f"{parameter.name}_at(pixel)" if parameter.name in inputs else f"{PARAMETER}{parameter.name}"
        for parameter in parameters
        if not parameter.out
    ]
    if "out" in outputs:
        glsl = outputs["out"].socket.glsl
        return f"\n{glsl} {function}_out({value_list}) {{ return {function}({', '.join(argument_list)}); }}\n"
    results = [parameter for parameter in parameters if parameter.out]
    locals = " ".join(f"{output.glsl} {output.name};" for output in results)
    call = f"{function}({', '.join([*argument_list, *(output.name for output in results)])});"
    return "".join(
        f"\n{output.glsl} {function}_{output.name}({value_list}) {{ {locals} {call} return {output.name}; }}\n"
        for output in results
    )

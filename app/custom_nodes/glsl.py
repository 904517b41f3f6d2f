"""A node made of GLSL: the last function of the text is the node, its signature declares sockets and values."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache
from hashlib import blake2b
from keyword import iskeyword
from types import new_class
from typing import Any, Literal, cast

from halation.nodes import Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, Pointwise, Socket, Value, Vector
from msgspec import Struct

from ..glsl import COMMENT, GlslFunction, blank_comments, macro_name, parse, unify_lines, words
from ..glsl.loops import guard_loops
from .code import Code, CodeFault, CustomNode
from .ending import add_ending
from .notes import Note, read_note
from .passes import make_passes
from .prefixes import prefix_names
from .securing import check_length, expand_code, guard_code
from .values import value_of

_FORBIDDEN = re.compile(
    r"\b(main|uniform|layout|buffer|shared|discard|barrier|texelFetch|texture\w*|gl_\w+"
    r"|image(?:Load|Store|Atomic)\w*|atomic\w+|subroutine|halation_\w+)\b"
    r"|^[ \t]*#[ \t]*(version|extension|pragma|line)\b",
    re.MULTILINE,
)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_RESERVED = frozenset({"out", "pixel", "extent", "frame", "proxy", "grid", "node", "muted", "code", "text", "title"})
KEPT = 512


class _Parameter(Struct, frozen=True):
    """One parameter of the function: its type, its name, the line it stands in and what is said of it."""

    glsl: str
    name: str
    out: bool
    line: int
    note: Note


@lru_cache(KEPT)
def glsl_node(code: Code) -> type[CustomNode]:
    """The class of the nodes that this code describes. Raises CodeFault."""
    check_length(code.text)
    source = unify_lines(code.text)
    plain = blank_comments(source)
    text = parse("written", source, code.name)
    _check_words(plain)
    if not text.all_functions:
        raise CodeFault(1, "there is no function in it: write one, such as vec4 tint(vec4 image) { return image; }")
    entry = text.all_functions[-1]
    parameters = tuple(_parameters(source, plain, entry))
    _check(entry, parameters)
    inputs = {one.name: _socket(one) for one in parameters if not one.out and not one.note.default}
    values = {
        one.name: value_of(one.glsl, one.name, one.note, one.line)
        for one in parameters
        if not one.out and one.note.default
    }
    outputs = {one.name: OutputSocket(_socket(one)) for one in parameters if one.out}
    if not outputs:
        outputs = {"out": OutputSocket(_picture(entry.result, Note(), entry.line, "the result"))}
    types = _list_types(inputs, values)
    expanded = expand_code(source, _list_macros(values), types, may_include=True)
    _check_words(expanded)
    functions = parse("written", expanded).all_functions
    _check_entry(entry, functions)
    looks = bool(words(expanded) & {f"{name}_{way}" for name in inputs for way in ("at", "near", "size")})
    names = {one.name for one in functions}
    return _make_class(code, expanded, names, types, entry, parameters, inputs, values, outputs, looks)


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
    looks: bool,
) -> type[CustomNode]:
    source = unify_lines(code.text)
    digest = blake2b(f"{code.language}\0{source}".encode(), digest_size=4).hexdigest()
    prefix = f"w{digest}_"
    function = prefix + entry.name
    edges = {one.note.edge for one in parameters if one.note.edge}
    if len(edges) > 1:
        raise CodeFault(entry.line, f"pictures end in different ways ({', '.join(sorted(edges))}): choose one edge")
    renamed = prefix_names(expanded, functions, prefix)
    looped = guard_loops(renamed)
    guarded = guard_code(looped, types)
    divides = guarded != looped
    renamed = add_ending(guarded, entry, prefix) if looped != renamed else guarded
    if divides:
        renamed += '\n#include "lib/whole.glsl"\n'
    body: dict[str, Any] = {"__module__": __name__, "__doc__": _doc(source, entry), "__annotations__": {}}
    for one in parameters:
        if one.name in inputs:
            body[one.name] = inputs[one.name]
        elif one.name in values:
            body[one.name] = values[one.name].default
            body["__annotations__"][one.name] = _hint(values[one.name])
    body |= outputs
    if looks:
        renamed += _entries(function, parameters, inputs, values, outputs)
        edge = cast("Edge", next(iter(edges), "clamp"))

        def passes(self: Filter, draw: Draw) -> Mapping[str, Drawn]:
            return make_passes(self, draw, function, edge)

        body["passes"] = passes
    base = Filter if looks else Pointwise
    node_class = cast(
        "type[CustomNode]", new_class(entry.name, (CustomNode, base), {}, lambda space: space.update(body))
    )
    name = f"written/{digest}"
    node_class.id, node_class.category = "glsl", "code"
    node_class.values = dict(values)
    node_class.function, node_class.shader = function, name
    node_class.code, node_class.title = code, entry.name.replace("_", " ")
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
        types |= {f"{name}_size": "ivec2", f"{name}_at()": "vec4", f"{name}_near()": "vec4"}
    return types | {name: value.glsl for name, value in values.items() if value.glsl}


def _parameters(source: str, plain: str, entry: GlslFunction) -> Iterator[_Parameter]:
    """The parameters of the function in order, each with the comments that stand beside it."""
    opened = plain.index("(", entry.start)
    closed = plain.index(")", opened)
    begins = [opened + 1, *(at + 1 for at in range(opened, closed) if plain[at] == ",")]
    if not plain[opened + 1 : closed].strip() or plain[opened + 1 : closed].strip() == "void":
        return
    for number, begin in enumerate(begins):
        last = number + 1 == len(begins)
        end = closed if last else begins[number + 1] - 1
        said = plain[begin:end].split()
        line = plain.count("\n", 0, begin + len(plain[begin:end]) - len(plain[begin:end].lstrip())) + 1
        words = [word for word in said if word not in ("in", "const", "highp", "mediump", "lowp")]
        out = bool(words) and words[0] == "out"
        words = words[1:] if out else words
        if len(words) != 2 or not _NAME.fullmatch(words[1]):
            raise CodeFault(line, f"'{' '.join(said)}' is no parameter that a node can have: write a type and a name")
        stop = source.find("\n", end)
        beside = COMMENT.search(source, end, len(source) if stop < 0 else stop)
        within = COMMENT.search(source, begin + len(plain[begin:end]) - len(plain[begin:end].lstrip()), end)
        comment = within or (beside if beside and not plain[end + 1 : beside.start()].strip(" \t){") else None)
        yield _Parameter(words[0], words[1], out, line, read_note(comment[0], line) if comment else Note())


def _check(entry: GlslFunction, parameters: tuple[_Parameter, ...]) -> None:
    names = set[str]()
    for one in parameters:
        if one.name in names or one.name in _RESERVED or iskeyword(one.name) or hasattr(Filter, one.name):
            why = "is there twice" if one.name in names else "means something else here"
            raise CodeFault(one.line, f"the name '{one.name}' {why}: choose another")
        names.add(one.name)
    outputs = [one for one in parameters if one.out]
    if outputs and entry.result != "void":
        raise CodeFault(entry.line, f"'{entry.name}' returns a {entry.result} and has out parameters: keep one of both")
    if outputs and parameters[-len(outputs) :] != tuple(outputs):
        raise CodeFault(outputs[0].line, "out parameters come last")
    if not outputs and entry.result == "void":
        raise CodeFault(entry.line, f"'{entry.name}' makes nothing: return a vec4, or write an out parameter")


def _socket(parameter: _Parameter) -> Socket:
    return _picture(parameter.glsl, parameter.note, parameter.line, f"'{parameter.name}'")


def _picture(glsl: str, note: Note, line: int, what: str) -> Socket:
    """What a picture of this GLSL type is to links."""
    if glsl == "vec4" and not note.vector:
        return Image(note.optional, doc=note.doc)
    if glsl == "float":
        return Field(note.optional, doc=note.doc)
    if glsl in ("vec2", "vec3", "vec4"):
        return Vector(note.optional, width=int(glsl[-1]), doc=note.doc)
    if glsl in ("int", "bool"):
        raise CodeFault(line, f"{what} is a {glsl}, which no picture holds: give it a default, such as // = 1")
    raise CodeFault(line, f"{what} has the type {glsl}: pictures are vec4, vec3, vec2 or float")


def _hint(value: Value) -> Any:
    """The Python type of a value."""
    if value.type == "choice":
        return Literal[value.choices]
    if value.type in ("color", "vector"):
        return tuple[(float,) * value.length]
    return {"float": float, "int": int, "bool": bool}[value.type]


def _doc(source: str, entry: GlslFunction) -> str:
    """The comment right above the function, else a sentence."""
    lines = source.split("\n")[: entry.line - 1]
    found: list[str] = []
    while lines and lines[-1].strip().startswith("//"):
        found.insert(0, lines.pop().strip().lstrip("/").strip())
    if not found and lines and lines[-1].strip().endswith("*/"):
        block = "\n".join(lines)
        start = block.rfind("/*")
        found = [line.strip(" *\t") for line in block[start + 2 : -2].split("\n")] if start >= 0 else []
    return "\n".join(found).strip() or "Code of this graph."


def _entries(
    function: str,
    parameters: tuple[_Parameter, ...],
    inputs: Mapping[str, Socket],
    values: Mapping[str, Value],
    outputs: Mapping[str, OutputSocket],
) -> str:
    """For each output a function that is drawn: it reads its own pixel of every picture and calls the user's."""
    value_list = ", ".join(f"{values[one.name].glsl} {one.name}" for one in parameters if one.name in values)
    argument_list = [f"{one.name}_at(pixel)" if one.name in inputs else one.name for one in parameters if not one.out]
    if "out" in outputs:
        glsl = outputs["out"].socket.glsl
        return f"\n{glsl} {function}_out({value_list}) {{ return {function}({', '.join(argument_list)}); }}\n"
    results = [one for one in parameters if one.out]
    declared = " ".join(f"{one.glsl} {one.name};" for one in results)
    call = f"{function}({', '.join([*argument_list, *(one.name for one in results)])});"
    return "".join(
        f"\n{one.glsl} {function}_{one.name}({value_list}) {{ {declared} {call} return {one.name}; }}\n"
        for one in results
    )

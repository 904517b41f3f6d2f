"""Edits of code nodes: set the text of a node or a file, move code between the graph and a file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast, get_args

from halation.nodes import Node, Plain
from msgspec import structs

from ...custom_nodes import Code, CodeFault, CustomNode, Language, node_type
from ...document.code import describe_code, read_code_file
from ...graph import Graph, Group, Item, Unknown
from ...graph.values import coerce, value_fault
from ...resources.sandbox import Sandbox
from ...watch.code_files import code_file, code_items

CODE = "glsl"
"""The type of nodes whose code is GLSL, in documents and in the list of what can be added."""

LANGUAGES: Mapping[str, str] = {"glsl": "GLSL", "isf": "ISF"}
"""The names of code languages."""

ENDINGS: Mapping[str, Language] = {".glsl": "glsl", ".fs": "isf"}
"""Files of code by the ending of their name."""

STARTER = """\
// Mixes a color into the picture.
vec4 tint(
    vec4 image,
    float amount,  // = 0.5, 0..1: How much of it.
    vec3 shade     // = (1, 0.5, 0.2), color: What is mixed in.
) {
    return vec4(mix(image.rgb, image.rgb * shade, amount), image.a);
}
"""


class BrokenCodeNode(Unknown, frozen=True):
    """A node whose `code` is invalid. The code in its file may be another one."""

    code: Code | None = None


def make_starter_node() -> Node:
    """A new node of code."""
    return node_type(Code(CODE, STARTER))()


def with_code_type(types: Mapping[str, type[Node]]) -> Mapping[str, type[Node]]:
    """The node types with that of a new node of code, under the name of its language."""
    return {**types, CODE: type(make_starter_node())}


def read_node_code(item: Item | None, folder: str, sandbox: Sandbox) -> Code | None:
    """The code of a node, even if it is invalid; None for nodes that are not made of code."""
    if isinstance(item, CustomNode):
        return item.code
    if not isinstance(item, Unknown) or item.type not in get_args(Language):
        return None
    language, file, lines = cast("Language", item.type), item.raw.get("file"), item.raw.get("code")
    if isinstance(item, BrokenCodeNode) and item.code is not None:
        return structs.replace(item.code, file=file or "")
    if isinstance(file, str):
        try:
            return read_code_file(language, file, folder, sandbox=sandbox)
        except CodeFault:
            return Code(language, "", file)
    return Code(language, "\n".join(map(str, lines or ())))


def make_code_node(code: Code, values: Mapping[str, Any] | None = None) -> Item:
    """A node made of code, with those of `values` that fit; a `BrokenCodeNode` if the code is invalid."""
    try:
        kind = node_type(code)
    except CodeFault as fault:
        return _make_broken(code, fault, values or {})
    return kind(**_keep_valid_values(kind, values or {}))


def make_file_node(file: str, folder: str, sandbox: Sandbox) -> Item:
    """A node whose code is in a file."""
    language = ENDINGS[Path(file).suffix.lower()]
    try:
        return make_code_node(read_code_file(language, file, folder, sandbox=sandbox))
    except CodeFault as fault:
        return _make_broken(Code(language, "", file), fault, {})


def set_code(graph: Graph, id: str, code: Code) -> Graph:
    """The graph with another code in a node. Links, values and animation stay where names and types agree."""
    return _replace_node(graph, id, make_code_node(code, _list_changed_values(graph.node(id))))


def file_texts(graph: Graph) -> dict[Path, str]:
    """The text of every code file, as the nodes of the graph and of its own groups have it."""
    text_by_file: dict[Path, str] = {}
    for body, item in code_items(graph, borrowed=False):
        file = code_file(item, body.folder)
        if file is not None and (isinstance(item, CustomNode | BrokenCodeNode)):
            text_by_file[file] = item.code.text if item.code else ""
    return text_by_file


def set_file_code(graph: Graph, file: Path, text: str, sandbox: Sandbox) -> Graph:
    """The graph with another text of a code file; the same object if no node uses the file."""
    return _map_code_nodes(
        graph,
        lambda body, id, item, code: (
            set_code(body, id, structs.replace(code, text=text))
            if code_file(item, body.folder) == file and code.text != text
            else body
        ),
        sandbox=sandbox,
    )


def reread_file_code(graph: Graph, file: Path, sandbox: Sandbox) -> Graph:
    """The graph with the code of a file as it is on the disk now; the same object if nothing differs."""

    def change(body: Graph, id: str, item: Item, code: Code) -> Graph:
        if file not in (path := code_file(item, body.folder), path and path.with_suffix(".vs")):
            return body
        try:
            disk_code = read_code_file(code.language, code.file, body.folder, sandbox=sandbox)
        except CodeFault as fault:
            return _replace_node(body, id, _make_broken(code, fault, _list_changed_values(item)))
        return (
            body
            if disk_code == code and isinstance(item, CustomNode | BrokenCodeNode)
            else set_code(body, id, disk_code)
        )

    return _map_code_nodes(graph, change, borrowed=True, sandbox=sandbox)


def embed_drafts(graph: Graph, drafts: Mapping[Path, str], sandbox: Sandbox) -> Graph:
    """The graph with code in it that differs from the file it belongs to, so that it is not lost with the graph."""
    return _map_code_nodes(
        graph,
        lambda body, id, item, code: (
            set_code(body, id, structs.replace(code, file="")) if code_file(item, body.folder) in drafts else body
        ),
        sandbox=sandbox,
    )


# --- inside ----------------------------------------------------------------------------------------------------------


def _map_code_nodes(
    graph: Graph, change: Callable[[Graph, str, Item, Code], Graph], borrowed: bool = False, *, sandbox: Sandbox
) -> Graph:
    """The graph with nodes of code changed, those of groups included; if `borrowed`, of groups from files too."""
    after = graph
    for id, item in graph.nodes.items():
        if isinstance(item, Group):
            inner = (
                _map_code_nodes(item.graph, change, borrowed, sandbox=sandbox)
                if borrowed or not item.path
                else item.graph
            )
            if inner is not item.graph:
                after = replace(after, nodes={**after.nodes, id: replace(item, graph=inner)})
        elif code := read_node_code(item, graph.folder, sandbox=sandbox):
            after = change(after, id, item, code)
    return after


def _list_changed_values(item: Item) -> Mapping[str, Any]:
    """The values of a node that are not at their default."""
    if isinstance(item, Unknown):
        raw = item.raw.get("values")
        return cast("Mapping[str, Any]", raw) if isinstance(raw, Mapping) else {}
    if isinstance(item, Group):
        return {}
    return {name: plain for name, plain in item.settings.items() if plain != item.values[name].default}


def _keep_valid_values(kind: type[Node], values: Mapping[str, Any]) -> dict[str, Plain]:
    valid_values: dict[str, Plain] = {}
    for name, value in kind.values.items():
        plain = coerce(value, values[name]) if name in values else None
        if plain is not None and value_fault(value, plain) is None:
            valid_values[name] = plain
    return valid_values


def _make_broken(code: Code, fault: CodeFault, values: Mapping[str, Any]) -> BrokenCodeNode:
    message = f"{code.name}, {fault}" if fault.line else str(fault)
    raw = {**describe_code(code), **({"values": dict(values)} if values else {})}
    return BrokenCodeNode(code.language, raw, message, code)


def _replace_node(graph: Graph, id: str, item: Item) -> Graph:
    """The graph with another node of that id; unknown keys of the document stay with it."""
    extra = {key: facts for key, facts in graph.extra.items() if key == f"nodes.{id}"}
    after = graph.replace(id, item)
    return replace(after, extra={**after.extra, **extra}) if extra and extra.keys() - after.extra.keys() else after

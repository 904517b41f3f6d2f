"""`halation nodes`: the catalogue of nodes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

import typer

from ..reference.facts import (
    default_text,
    hard_range,
    node_doc,
    node_facts,
    output_type,
    plan_facts,
    socket_note,
    socket_type,
    soft_range,
)
from ..resources.sandbox import Sandbox
from .options import AsJson
from .outcome import print_json, print_note
from .plugins import describe_refused_plugins, print_refused_plugins

if TYPE_CHECKING:
    from halation.nodes import Node, Value


_Id = Annotated[
    str,
    typer.Argument(
        help="A node, a menu or another name of nodes, or a code file (FILE.fs, FILE.glsl); without it all nodes are "
        "listed."
    ),
]
_Check = Annotated[
    bool,
    typer.Option(
        "--check",
        help="Check a node, or all nodes of a plug-in (by its package or import name), or of all plug-ins: "
        "tooltip, units, ranges, shader, pixels. Exits with 1 if something is wrong.",
    ),
]
_Markdown = Annotated[bool, typer.Option("--markdown", help="Print the whole catalogue as one Markdown page.")]


def nodes(
    id: _Id = "",
    check: _Check = False,
    markdown: _Markdown = False,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """List all nodes, or describe one.

    The description has its sockets, values, ranges and units, and the passes that it compiles to. The name of a menu,
    or one that other programs give such a node, lists the nodes that it fits.
    """
    if check:
        from .node_check import check_nodes

        return check_nodes(id, as_json, sandbox)
    from halation.nodes import catalogue

    from ..errors import UsageError

    classes = catalogue()
    if id.endswith((".fs", ".glsl")):
        classes = {id: _load_code(id, sandbox=sandbox)}
    word = ""
    if id and id not in classes:
        classes, word, id = _find_nodes(id, classes), id, ""
    if markdown and (id or word or as_json):
        raise UsageError("--markdown prints the whole catalogue: leave out the node and --json")
    if markdown:
        from .manual import catalogue_page

        print(catalogue_page(list(classes.values())), end="")
    elif as_json:
        print_json(
            node_facts(classes[id])
            if id
            else {"nodes": [node_facts(node) for node in classes.values()], **describe_refused_plugins()}
        )
    elif id:
        _print_node(classes[id])
        menu = [node.id for node in classes.values() if node.category == id]
        if menu:
            print_note(f"the menu {id} has {', '.join(menu)}")
    else:
        _list_nodes(list(classes.values()))
        print_refused_plugins()
    return 0


def _find_nodes(word: str, classes: Mapping[str, type[Node]]) -> dict[str, type[Node]]:
    """The nodes of the menu of this name, and those that have it, or hold it as whole words, in a name of theirs.

    Raises UsageError if there are none.
    """
    from ..custom_nodes.plugins import find_preset, find_refused_plugin
    from ..errors import UsageError
    from ..graph import did_you_mean

    words = f" {_separate_words(word)} "
    matches = {
        id: node
        for id, node in classes.items()
        if words == f" {node.category} "
        or any(words in f" {_separate_words(name)} " for name in (node.title, *node.aliases))
    }
    if matches and words.strip():
        return matches
    if plugin := find_refused_plugin(word):
        raise UsageError(f"there is no node '{word}': the plug-in {plugin} cannot be loaded: {plugin.fault}")
    if find_preset(word):
        raise UsageError(f"'{word}' is a preset: halation info {word} says what it takes and what can be set in it")
    menus = {node.category for node in classes.values()}
    # Only packages have a hyphen, and no node is meant by the name of one that is not installed.
    hint = "" if "-" in word else did_you_mean(word, [*classes, *menus])
    raise UsageError(f"there is no node, menu or installed plug-in '{word}'{hint}")


def _separate_words(name: str) -> str:
    """A name in lower case with one blank between its words."""
    return " ".join(re.findall(r"[^\W_]+", name.lower()))


def _load_code(file: str, sandbox: Sandbox) -> type[Node]:
    """The node that a code file defines. Raises UsageError."""
    from ..custom_nodes import CodeFault, node_type
    from ..document.code import read_code_file
    from ..errors import UsageError

    try:
        return node_type(read_code_file("isf" if file.endswith(".fs") else "glsl", file, "", sandbox=sandbox))
    except CodeFault as fault:
        raise UsageError(f"{file}, {fault}" if fault.line else str(fault)) from None


def _list_nodes(classes: list[type[Node]]) -> None:
    width = max(len(node.id) for node in classes)
    category = ""
    for node in classes:
        if node.category != category:
            category = node.category
            print(f"\n{category}")
        source = f" ({node.required_package.replace('==', ' ')})" if node.required_package else ""
        print(f"  {node.id:<{width}}  {node_doc(node).splitlines()[0]}{source}")


def _print_node(node: type[Node]) -> None:
    source = f", from {node.required_package.replace('==', ' ')}" if node.required_package else ""
    print(f"{node.id}  ({node.category}, version {node.version}{source})\n\n{node_doc(node)}\n")
    if node.aliases:
        print(f"also known as {', '.join(node.aliases)}\n")
    inputs = [(name, socket, socket_type(socket)) for name, socket in node.inputs.items()]
    outputs = [(name, output.socket, output_type(output)) for name, output in node.outputs.items()]
    for title, sockets in (("inputs", inputs), ("outputs", outputs)):
        if sockets:
            print(title)
            for name, socket, type_text in sockets:
                print(f"  {name:<16} {type_text:<10} {socket_note(socket)}".rstrip())
            print()
    if node.values:
        print("values")
        for value in node.values.values():
            print(f"  {value.name:<16} {value.type:<10} {default_text(value):<14} {_describe_range(value)}".rstrip())
            if value.doc:
                print(f"  {'':<16} {value.doc}")
        print()
    _print_passes(node)


def _print_passes(node: type[Node]) -> None:
    from ..compiler.explain import format_bytes

    facts = plan_facts(node)
    width, height = facts["size"]
    print(f"passes at these values, {width}x{height}")
    widest = max((len(item["label"]) for item in facts["passes"]), default=0)
    for index, item in enumerate(facts["passes"]):
        surfaces = ", ".join(f"{'x'.join(map(str, surface['size']))} {surface['format']}" for surface in item["writes"])
        print(f"  {index:<4} {item['label']:<{widest}}  {surfaces}")
    if not facts["passes"]:
        print(f"  none: {'the picture passes through unchanged' if node.inputs else 'nothing has to be drawn'}")
    print(f"  {format_bytes(facts['peak_bytes'])} of textures at the peak")


def _describe_range(value: Value) -> str:
    if value.choices:
        return " | ".join(value.choices)
    soft, hard = f"{soft_range(value)} {value.unit or ''}".strip(), hard_range(value)
    return f"{soft} ({hard})" if hard else soft

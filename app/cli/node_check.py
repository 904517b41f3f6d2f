"""`halation nodes --check`: checks that nodes, those of plug-ins too, keep the promises of all nodes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..resources.sandbox import Sandbox
from .outcome import print_json, print_note, write_count

if TYPE_CHECKING:
    from halation.nodes import Node, Plugin


def check_nodes(name: str, as_json: bool, sandbox: Sandbox) -> int:
    """Check the nodes that a name stands for, print what is wrong, and return the exit code. Raises UsageError."""
    from halation.nodes import plugins

    from ..regression.node_promises import find_declaration_faults, find_render_faults, find_shader_faults
    from ..renderer import Renderer, open_device

    classes, chosen = _choose_nodes(name, plugins())
    faults = {str(plugin): [f"it cannot be loaded: {plugin.fault}"] for plugin in chosen if plugin.fault}
    renderer = Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
    try:
        for id, node in classes.items():
            faults[id] = [*find_declaration_faults(node), *find_shader_faults(node)]
            faults[id] += () if faults[id] else find_render_faults(renderer, node)
    finally:
        renderer.close()
    for shader, sentences in _find_file_faults(chosen, classes):
        faults |= {shader: sentences} if sentences else {}
    if as_json:
        print_json({"faults": faults})
    else:
        for subject, sentences in faults.items():
            print(*(f"{subject}: {sentence}" for sentence in sentences or ("ok",)), sep="\n")
        count = sum(map(bool, faults.values()))
        print_note(f"{write_count(len(classes), 'node')}: {count or 'nothing'} to mend")
    return 1 if any(faults.values()) else 0


def _choose_nodes(name: str, plugins: tuple[Plugin, ...]) -> tuple[Mapping[str, type[Node]], list[Plugin]]:
    """The nodes to check by id, and the plug-ins that are checked as a whole. Raises UsageError."""
    from halation.nodes import catalogue

    from ..graph import did_you_mean

    if name in catalogue():
        return {name: catalogue()[name]}, []
    chosen = [plugin for plugin in plugins if not name or name in (plugin.package, plugin.namespace)]
    if not chosen and not name:
        raise UsageError("no plug-in is installed: name a node, such as halation nodes bloom --check")
    if not chosen:
        names = [plugin.package for plugin in plugins]
        raise UsageError(f"there is no node and no plug-in '{name}'{did_you_mean(name, [*names, *catalogue()])}")
    return {id: node for plugin in chosen for id, node in plugin.nodes.items()}, chosen


def _find_file_faults(chosen: list[Plugin], classes: Mapping[str, type[Node]]) -> Iterator[tuple[str, list[str]]]:
    """The faults in each shader file of the chosen plug-ins, or in those of single nodes."""
    from ..compiler import load_library
    from ..regression.node_promises import find_file_faults

    names = [name for name in load_library().texts if not name.startswith("viewer/")]
    namespaces = tuple(f"{plugin.namespace}/" for plugin in chosen)
    shaders = {node.shader for node in classes.values()}
    for name in names:
        if name.startswith(namespaces) if chosen else name in shaders:
            yield name, list(find_file_faults(name, names))

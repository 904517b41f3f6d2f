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
    from ..regression.read_areas import find_overlap_faults
    from ..renderer import Renderer, open_device

    classes, chosen = _choose_nodes(name, plugins())
    faults = {str(plugin): [f"it cannot be loaded: {plugin.fault}"] for plugin in chosen if plugin.fault}
    renderer = Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
    try:
        for id, node in classes.items():
            faults[id] = [*find_declaration_faults(node), *find_shader_faults(node)]
            faults[id] += () if faults[id] else find_render_faults(renderer, node)
            faults[id] += () if faults[id] else find_overlap_faults(renderer, node)
    finally:
        renderer.close()
    reported = {sentence for sentences in faults.values() for sentence in sentences}
    for subject, sentences in _find_file_faults(chosen, classes):
        if new_faults := [sentence for sentence in sentences if sentence not in reported]:
            faults[subject] = [*faults.get(subject, ()), *new_faults]
    if as_json:
        print_json({"faults": faults})
    else:
        for subject, sentences in faults.items():
            print(*(f"{subject}: {sentence}" for sentence in sentences or ("ok",)), sep="\n")
        _print_summary(classes, sum(map(bool, faults.values())), sum(bool(plugin.fault) for plugin in chosen))
    return 1 if any(faults.values()) else 0


def _print_summary(classes: Mapping[str, type[Node]], faulty_count: int, refused_count: int) -> None:
    """Print how many nodes were checked and how many subjects have faults, and what is unusual about masks."""
    for id, node in classes.items():
        if node.own_mask_names:
            names = " and ".join(f"'{name}'" for name in node.own_mask_names)
            added = "only mix" if node.has_mix else "no mask, mix and invert_mask"
            print_note(f"{id}: it declares {names} itself, so that Halation adds {added}")
    parts = [f"{write_count(refused_count, 'plug-in')} cannot be loaded"] if refused_count else []
    if classes or not refused_count:
        parts.append(f"{write_count(len(classes), 'node')}: {faulty_count - refused_count or 'nothing'} to mend")
    print_note("; ".join(parts))


def _choose_nodes(name: str, plugins: tuple[Plugin, ...]) -> tuple[Mapping[str, type[Node]], list[Plugin]]:
    """The nodes to check by id, and the plug-ins that are checked as a whole. Raises UsageError."""
    from halation.nodes import catalogue

    from ..custom_nodes.plugins import find_refused_plugin
    from ..graph import did_you_mean

    if name in catalogue():
        return {name: catalogue()[name]}, []
    chosen = [plugin for plugin in plugins if not name or name in (plugin.package, plugin.namespace)]
    if not chosen and not name:
        raise UsageError("no plug-in is installed: name a node, such as halation nodes bloom --check")
    if refused_plugin := find_refused_plugin(name):
        fault = f"the plug-in {refused_plugin} cannot be loaded: {refused_plugin.fault}"
        raise UsageError(f"there is no node '{name}': {fault}")
    if not chosen:
        packages = [name for plugin in plugins for name in (plugin.package, plugin.namespace)]
        # Only packages have a hyphen, and no node is meant by the name of one that is not installed.
        hint = did_you_mean(name, packages if "-" in name else [*packages, *catalogue()])
        rest = f"the plug-ins are {', '.join(map(str, plugins))}" if plugins else "no plug-in is installed"
        way_out = hint or f": name a node, or an installed plug-in by its package or import name; {rest}"
        raise UsageError(f"there is no node and no installed plug-in '{name}'{way_out}")
    return {id: node for plugin in chosen for id, node in plugin.nodes.items()}, chosen


def _find_file_faults(chosen: list[Plugin], classes: Mapping[str, type[Node]]) -> Iterator[tuple[str, list[str]]]:
    """The faults in each shader file of the chosen plug-ins, or in those of single nodes, by the node or the file."""
    from ..compiler import load_library
    from ..regression.node_promises import find_file_faults

    library = load_library()
    names = [name for name in library.texts if not name.startswith("viewer/")]
    namespaces = tuple(f"{plugin.namespace}/" for plugin in chosen)
    owners = {node.shader: id for id, node in classes.items()}
    for name in names:
        if name.startswith(namespaces) if chosen else name in owners:
            yield owners.get(name) or name, list(find_file_faults(name, names))

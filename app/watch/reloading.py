"""Files of nodes, read again while the editor runs, and graphs brought over to the classes that come out of them."""

from __future__ import annotations

import importlib
import json
import sys
import traceback
from collections.abc import Mapping
from dataclasses import replace
from importlib.util import find_spec, module_from_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from halation import nodes, shaders
from halation.nodes import Node, built_in_nodes, catalogue

from .. import document
from ..custom_nodes import CustomNode
from ..errors import DocumentError, GraphError
from ..graph import Graph, Group, Item, Unknown

Types = Mapping[str, type[Node]]


def shader_folder() -> Path:
    """Where the shaders are that nodes use."""
    return Path(shaders.__path__[0])


class NodeFiles:
    """The files of the catalogue, as they were when this was made, or read again last.

    A class that is loaded only later may come from a newer file, which `reload` then reads once more.

    The vocabulary is not read again: what is a node, and what is not, would change its meaning under living graphs.
    """

    def __init__(self) -> None:
        self.folder = Path(nodes.__path__[0])
        self._texts = self._read()

    def reload(self) -> str:
        """Make `catalogue()` what the files say now; "" if so. A fault, in a sentence, leaves all classes as they were.

        Classes whose file is unchanged stay the same ones.
        """
        try:
            texts = self._read()
        except OSError as fault:
            return f"{fault.filename}: cannot be read ({fault.strerror}); all nodes stay as they were"
        changed = {name for name in {*texts, *self._texts} if texts.get(name) != self._texts.get(name)}
        if not changed:
            return ""
        if not all(self._is_ours(name) for name in changed):
            return "the vocabulary of nodes has changed (nodes/_declare): start the editor again to use it"
        # Files of nodes stand alone; anything else among them may be used by all.
        alone = all(name.count(".") == nodes.__name__.count(".") + 2 and "._" not in name for name in changed)
        stale = changed if alone else {name for name in {*texts, *self._texts} if self._is_ours(name)}
        before = {name: sys.modules.pop(name, None) for name in stale}
        importlib.invalidate_caches()
        try:
            for name in sorted(stale & texts.keys()):
                if name not in sys.modules:
                    _load(name, texts[name])
            dict(built_in_nodes.__wrapped__())
        except (Exception, SystemExit) as fault:
            for name, module in before.items():
                _install(name, module)
            return f"{self._describe_fault(fault)}; all nodes stay as they were"
        nodes.reload_catalogue()
        self._texts = texts
        return ""

    def _is_ours(self, name: str) -> bool:
        return name != nodes.__name__ and not name.startswith(f"{nodes.__name__}._")

    def _read(self) -> dict[str, bytes]:
        """The text of every file by the name of its module. Raises OSError."""
        texts: dict[str, bytes] = {}
        for path in sorted(self.folder.rglob("*.py")):
            parts = path.relative_to(self.folder).with_suffix("").parts
            texts[".".join((nodes.__name__, *(part for part in parts if part != "__init__")))] = path.read_bytes()
        return texts

    def _describe_fault(self, fault: BaseException) -> str:
        """Where in the files of nodes it went wrong, and what."""
        reason = fault.msg if isinstance(fault, SyntaxError) else str(fault) or type(fault).__name__
        places = [(Path(frame.filename), frame.lineno) for frame in traceback.extract_tb(fault.__traceback__)]
        if isinstance(fault, SyntaxError) and fault.filename:
            places.append((Path(fault.filename), fault.lineno))
        for path, line in reversed(places):
            if path.is_relative_to(self.folder) and path.parent not in (self.folder, self.folder / "_declare"):
                return f"{path.relative_to(self.folder.parent).as_posix()}, line {line}: {reason}"
        return reason


def _load(name: str, text: bytes) -> None:
    """Run a module from its text: a compiled one beside it may be of another text of the same second."""
    spec = find_spec(name)
    if spec is None or spec.origin is None:
        return
    module = module_from_spec(spec)
    _install(name, module)
    exec(compile(text, spec.origin, "exec", dont_inherit=True), vars(module))


def _install(name: str, module: ModuleType | None) -> None:
    """Make it the module of that name; None if there is none."""
    package, _, short = name.rpartition(".")
    if module is None:
        sys.modules.pop(name, None)
        return
    sys.modules[name] = module
    if package in sys.modules:
        setattr(sys.modules[package], short, module)


def migrate_graph(graph: Graph, types: Types | None = None) -> Graph:
    """The same graph made of these classes (default: `catalogue()`); the very same one if it is already.

    Values that no longer fit have their default. Nodes of a type that is gone become unknown ones, and come back.
    """
    types_by_id = catalogue() if types is None else types
    changed = {id: part for id, item in graph.nodes.items() if (part := _migrate_node(graph, id, item, types_by_id))}
    if not changed:
        return graph
    extra = {key: keys for key, keys in graph.extra.items() if not any(_is_of(key, id) for id in changed)}
    for part in changed.values():
        extra |= part.extra
    return replace(graph, nodes={**graph.nodes, **{id: part.nodes[id] for id, part in changed.items()}}, extra=extra)


def _migrate_node(graph: Graph, id: str, item: Item, types: Types) -> Graph | None:
    """A graph of that node alone, or None if it stays as it is."""
    own_keys = {key: keys for key, keys in graph.extra.items() if _is_of(key, id)}
    if isinstance(item, Group):
        inner = migrate_graph(item.graph, types)
        return None if inner is item.graph else Graph({id: replace(item, graph=inner)}, extra=own_keys)
    if isinstance(item, CustomNode):
        return None
    current_class = types.get(item.type if isinstance(item, Unknown) else item.id)
    if (current_class is None and isinstance(item, Unknown)) or type(item) is current_class:
        return None
    try:
        tree = json.loads(document.dumps(Graph({id: item}, extra=own_keys)))
    except GraphError:
        return None
    node: dict[str, Any] = tree["nodes"][id]
    if current_class is not None and isinstance(item, Node):
        node["version"] = min(item.version, current_class.version)
    return _load_fitting(tree, id, graph.folder, types)


def _load_fitting(tree: dict[str, Any], id: str, folder: str, types: Types) -> Graph | None:
    """The graph that the tree says, without values that do not fit; None if it is beyond that."""
    values: Any = tree["nodes"][id].get("values")
    while True:
        try:
            return document.loads(json.dumps(tree), folder=folder, catalogue=types, sandbox=None)
        except DocumentError as fault:
            name = fault.path.removeprefix(f"nodes.{id}.values.")
            if not isinstance(values, dict) or values.pop(name, None) is None:
                return None


def _is_of(key: str, id: str) -> bool:
    """True if an entry of `Graph.extra` belongs to the node."""
    return key == f"nodes.{id}" or key.startswith(f"nodes.{id}.")

"""Commands that add nodes: from a type, from files, into a link."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from halation.nodes import Node, Plain

from ...custom_nodes.plugins import preset_paths
from ...document import load
from ...errors import GraphError
from ...graph import Graph, Group, Item, Port, did_you_mean, signature
from ...language.translation import translate
from ...render_layers.render import is_render
from ...watch.sequence_files import representative_file
from ..edits import appending, coding, elements, layout, naming, paths, room, routes, surface_layers, wiring
from ..edits.element_id import ElementId
from ..edits.elements import Place, Sizes
from ..edits.ends import without_samples
from ..state.open_document import OpenDocument
from .absent_layers import list_absent_outputs
from .command import EditCommand, Edited
from .metals import connect_metals

ABOVE = 380.0
"""Canvas units between a render's node and a matte node above it: the height of a `read_render` with all outputs."""


class AddNode(EditCommand[str], frozen=True):
    """Add a node of a type at canvas position `at`, and select it; gives its id.

    With `link`, a source if `output` else a target, it is linked by the first socket that fits. `values` are those that
    differ from the defaults.
    """

    type_id: str
    at: Place = (0.0, 0.0)
    link: Port | None = None
    output: bool = True
    values: Sequence[tuple[str, Plain]] = ()

    def apply(self, document: OpenDocument) -> Edited[str]:
        item = make_node(document, self.type_id).with_values(**dict(self.values))
        return add_item(document, type_stem(self.type_id), item, self.at, self.link, self.output)


class AddGroupFile(EditCommand[str], frozen=True):
    """Add a graph file as a node; gives its id."""

    path: str | Path
    at: Place = (0.0, 0.0)
    link: Port | None = None
    output: bool = True

    def apply(self, document: OpenDocument) -> Edited[str]:
        item = load_group(document, self.path)
        return add_item(document, naming.node_stem(self.path), item, self.at, self.link, self.output)


class AddCodeFile(EditCommand[str], frozen=True):
    """Add a node whose code is in a file; gives its id."""

    path: str | Path
    at: Place = (0.0, 0.0)
    link: Port | None = None
    output: bool = True

    def apply(self, document: OpenDocument) -> Edited[str]:
        item = _make_code_node(document, self.path)
        return add_item(document, naming.node_stem(self.path), item, self.at, self.link, self.output)


class AppendNode(EditCommand[str], frozen=True):
    """Add a node behind what is selected, linked with it and in free room; gives its id. Several make a chain.

    If the viewer shows what feeds the node, it shows the node then, unless that still needs a link.
    """

    addition: AddNode | AddGroupFile | AddCodeFile
    sizes: Sizes | None = None

    def apply(self, document: OpenDocument) -> Edited[str]:
        edited = self.addition.apply(document)
        assert edited.graph is not None
        selected = sorted(document.selection, key=lambda element: (element != document.active, element))
        absent = list_absent_outputs(document, surface_layers.list_behind(document.graph, selected))
        graph = appending.append_node(edited.graph, edited.outcome, selected, self.sizes, absent)
        graph = connect_metals(document, graph, edited.outcome, self.sizes)
        follows = _list_followed(graph, edited.outcome)
        return Edited(edited.label, edited.outcome, graph, (ElementId(edited.outcome),), follows=follows)


class AddMatte(EditCommand[str], frozen=True):
    """Add a node that cuts out of the render that node `id` reads, above it; gives its id."""

    id: str
    kind: str = ""

    def apply(self, document: OpenDocument) -> Edited[str]:
        path = document.graph.value(Port(self.id, "path"))
        node = make_node(document, "cryptomatte").with_values(path=path, **({"layer": self.kind} if self.kind else {}))
        x, y = document.positions[ElementId(self.id)]
        return add_item(document, "cryptomatte", node, (x, y - ABOVE))


class InsertNode(EditCommand[str], frozen=True):
    """Put a node into the link that feeds `target`: an existing one by id, else a new one of that type; gives its id.

    What depends on it is pushed aside where it is in the way.
    """

    node: str
    target: Port
    at: Place | None = None
    sizes: Sizes | None = None

    def apply(self, document: OpenDocument) -> Edited[str]:
        if self.node in document.graph.nodes:
            graph, id = document.graph, self.node
            if self.at is not None:
                graph = elements.with_places(graph, {ElementId(id): self.at})
        else:
            id = document.graph.fresh_id(type_stem(self.node))
            graph = document.graph.add(id, make_node(document, self.node))
            graph = elements.with_places(graph, {ElementId(id): self.at or self._find_middle(document)})
        node = ElementId(id)
        graph = room.make_space(wiring.insert_node(graph, id, self.target), (node,), self.target, self.sizes)
        return Edited(translate("Insert {id}", id=id), id, graph, (node,))

    def _find_middle(self, document: OpenDocument) -> Place:
        """Halfway between the ends of the link."""
        source = document.graph.links.get(self.target, self.target)
        ends = [ElementId.of_port(end) for end in (self.target, source)]
        spots = [document.positions.get(key, (0.0, 0.0)) for key in ends]
        return (spots[0][0] + spots[1][0]) / 2.0, (spots[0][1] + spots[1][1]) / 2.0


class SpliceChain(EditCommand[None], frozen=True):
    """Put a chain of nodes, moved by a distance with the dots in it, into the link that feeds `target`.

    What depends on it is pushed aside where it is in the way.
    """

    ids: Collection[str]
    target: Port
    by: Place = (0.0, 0.0)
    sizes: Sizes | None = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        ids = {ElementId(id) for id in self.ids if id in graph.nodes}
        places = {key: document.positions[key] for key in (*ids, *routes.inner_dots(graph, ids))}
        moved = {key: (x + self.by[0], y + self.by[1]) for key, (x, y) in places.items()}
        graph = wiring.splice_chain(elements.with_places(graph, moved), ids, self.target)
        graph = room.make_space(graph, ids, self.target, self.sizes)
        return Edited(
            translate("Insert {elements}", elements=naming.describe_elements(ids)), None, graph, merge=self.merge
        )


class DropFiles(EditCommand[tuple[str, ...]], frozen=True):
    """Add files as nodes: graphs become groups, shaders code, renders `read_render`, others `read_image`; gives ids.

    They stand below each other in a column, where they cover nothing.
    """

    paths: Sequence[str | Path]
    at: Place = (0.0, 0.0)
    sizes: Sizes | None = None

    def apply(self, document: OpenDocument) -> Edited[tuple[str, ...]]:
        graph, ids = document.graph, list[str]()
        if not self.paths:
            return Edited(translate("Drop files"), ())
        x, y = self.at
        for path in self.paths:
            id = graph.fresh_id(naming.node_stem(path))
            node = ElementId(id)
            graph = elements.with_places(graph.add(id, _make_file_item(document, path)), {node: (x, y)})
            sizes = appending.estimate_sizes(graph, self.sizes)
            places = {key: at for key, at in layout.positions(graph, sizes).items() if key != node}
            x, y = layout.find_free_place(graph, node, (x, y), places, sizes)
            graph = elements.with_places(graph, {node: (x, y)})
            y += sizes[node][1] + layout.GAP[1]
            ids.append(id)
        label = naming.node_stem(self.paths[0]) if len(ids) == 1 else f"{len(ids)} files"
        return Edited(translate("Drop {label}", label=label), tuple(ids), graph, map(ElementId, ids))


def _list_followed(graph: Graph, id: str) -> dict[Port, Port]:
    """What feeds a new node, with its first output; empty for a node that has no output or still needs a link."""
    sockets = signature(graph.nodes[id])
    needed = (Port(id, name) for name, socket in sockets.inputs.items() if not socket.optional)
    if not sockets.outputs or any(port not in graph.links for port in needed):
        return {}
    output = Port(id, next(iter(sockets.outputs)))
    return {source: output for target, source in graph.links.items() if target.node == id}


def make_node(document: OpenDocument, type_id: str) -> Node:
    """A new node of a type. Raises GraphError for an unknown type."""
    if type_id == coding.CODE:
        return coding.make_starter_node()
    if type_id not in document.types:
        raise GraphError(
            translate(
                "there is no node type '{type_id}'{suggestion}",
                type_id=type_id,
                suggestion=did_you_mean(type_id, document.types),
            )
        )
    return document.types[type_id]()


def type_stem(type_id: str) -> str:
    """The name of new nodes of a type: without the namespace of a plug-in."""
    return "code" if type_id == coding.CODE else type_id.rpartition(".")[2]


def add_item(
    document: OpenDocument, stem: str, item: Item, at: Place, link: Port | None = None, output: bool = True
) -> Edited[str]:
    """A node added under a free id like `stem`, linked with `link` if that is given, and selected."""
    id = document.graph.fresh_id(stem)
    graph = elements.with_places(document.graph.add(id, item), {ElementId(id): at})
    if link is not None:
        graph = wiring.link_node(graph, id, link, output)
    return Edited(translate("Add {id}", id=id), id, graph, (ElementId(id),))


def load_group(document: OpenDocument, path: str | Path) -> Group:
    """A graph file as a group. Raises DocumentError, and GraphError if it contains this document.

    Presets become part of the document, without their sample pictures: the document must not depend on where Halation
    is installed.
    """
    body = load(path, document.types, sandbox=document.sandbox)
    own_path = document.path.resolve() if document.path else None
    if own_path in {Path(path).resolve(), *(file.resolve() for file in paths.group_files(body))}:
        raise GraphError(
            translate("a group cannot hold itself: '{name}' is this document or holds it", name=Path(path).name)
        )
    if Path(path).resolve() in {preset.resolve() for preset in preset_paths()}:
        return Group(paths.rebase_paths(without_samples(body), document.root.folder))
    return Group(body, paths.make_relative(path, document.root.folder))


def _make_file_item(document: OpenDocument, path: str | Path) -> Item:
    suffix = Path(path).suffix.lower()
    if suffix == ".json":
        return load_group(document, path)
    if suffix in coding.ENDINGS:
        return _make_code_node(document, path)
    reads_render = "read_render" in document.types and is_render(
        representative_file(Path(path), sandbox=document.sandbox), sandbox=document.sandbox
    )
    node = make_node(document, "read_render" if reads_render else "read_image")
    return node.with_values(path=paths.make_relative(path, document.root.folder))


def _make_code_node(document: OpenDocument, path: str | Path) -> Item:
    """A node made of the code in a file."""
    folder = document.root.folder
    return coding.make_file_node(paths.make_relative(path, folder), folder, sandbox=document.sandbox)

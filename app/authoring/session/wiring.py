"""Nodes and the links between them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from halation.nodes import Node

from ...custom_nodes.plugins import preset_paths
from ...document import load
from ...errors import GraphError
from ...graph import Graph, Group, Item, Port, did_you_mean
from ...render_layers.render import is_render
from ...watch.sequence_files import representative_file
from ..edits import coding, deleting, elements, naming, paths, room, routes, wiring
from ..edits.elements import Place, Sizes
from ..edits.ends import without_samples
from .state import State

DROP_STEP = 100.0
"""Distance between nodes of files that were dropped together."""
ABOVE = 380.0
"""How far above a render a node is put that reads the same file."""


class Wiring(State):
    """Adding, linking, taking out and removing."""

    def add_node(self, type_id: str, at: Place = (0.0, 0.0), link: Port | None = None, output: bool = True) -> str:
        """A new node of that type at canvas position `at`, selected; returns its id.

        With `link`, a source if `output` else a target, it is linked by the first socket that fits.
        """
        return self._add(_stem(type_id), self._new(type_id), at, link, output)

    def add_group(self, path: str | Path, at: Place = (0.0, 0.0), link: Port | None = None, output: bool = True) -> str:
        """A graph file as a node; returns its id."""
        return self._add(naming.node_stem(path), self._group(path), at, link, output)

    def add_code_file(
        self, path: str | Path, at: Place = (0.0, 0.0), link: Port | None = None, output: bool = True
    ) -> str:
        """A node whose code is in a file; returns its id."""
        item = coding.make_file_node(self.relative(path), self.root.folder)
        return self._add(naming.node_stem(path), item, at, link, output)

    def insert(self, node: str, target: Port, at: Place | None = None, sizes: Sizes | None = None) -> str:
        """Put a node into the link that feeds `target`: an existing one by id, else a new one of that type.

        What depends on it is pushed aside where it is in the way.
        """
        if node in self.graph.nodes:
            graph, id = self.graph, node
            if at is not None:
                graph = elements.with_places(graph, {id: at})
        else:
            id = self.graph.fresh_id(_stem(node))
            graph = elements.with_places(self.graph.add(id, self._new(node)), {id: at or self._middle(target)})
        self.edit(f"Insert {id}", room.make_space(wiring.insert_node(graph, id, target), (id,), target, sizes), (id,))
        return id

    def splice(
        self, ids: Collection[str], target: Port, by: Place = (0.0, 0.0), sizes: Sizes | None = None, merge: str = ""
    ) -> None:
        """Put a chain of nodes, moved by a distance with the dots in it, into the link that feeds `target`.

        What depends on it is pushed aside where it is in the way.
        """
        graph = self.graph
        some = {id for id in ids if id in graph.nodes}
        moved = {key: self.positions[key] for key in (*some, *routes.inner_dots(graph, some))}
        graph = elements.with_places(graph, {key: (x + by[0], y + by[1]) for key, (x, y) in moved.items()})
        graph = room.make_space(wiring.splice_chain(graph, some, target), some, target, sizes)
        self.edit(f"Insert {naming.describe_elements(some)}", graph, merge=merge)

    def fitting(self, port: Port, is_output: bool) -> tuple[str, ...]:
        """Ids of the node types that could be linked with `port`, a source if `is_output`."""
        return wiring.fitting_types(
            self.graph, port, is_output, {**self.types, coding.CODE: type(coding.make_starter_node())}
        )

    def fits_picture(self, port: Port, is_output: bool) -> bool:
        """True if a port could be linked with a picture, as a source if `is_output`."""
        return wiring.fits_picture(self.graph, port, is_output)

    def fitting_files(self, files: Sequence[Path], port: Port, is_output: bool) -> tuple[Path, ...]:
        """Those of some graph files that could, as groups, be linked with `port`, a source if `is_output`."""
        self._offered |= {file: Group(load(file, self.types)) for file in files if file not in self._offered}
        return tuple(file for file in files if wiring.fits(self.graph, port, is_output, self._offered[file]))

    def refusal(self, source: Port, target: Port) -> str | None:
        """Why that link cannot be, or None."""
        return wiring.why_not_linkable(self.graph, source, target)

    def connect(self, source: Port, target: Port) -> None:
        """Link `source` to `target`, in place of what fed it."""
        self.edit(f"Link {source} to {target}", self.graph.connect(source, target))

    def disconnect(self, target: Port) -> None:
        """Remove the link to `target`."""
        self.edit(f"Unlink {target}", self.graph.disconnect(target))

    def disconnect_all(self, key: str) -> None:
        """Remove every link of a node or end."""
        links = self.graph.links.items()
        self.edit(
            f"Unlink {key}",
            wiring.cut_links(
                self.graph,
                [end for end, start in links if key in (elements.element_of(end), elements.element_of(start))],
            ),
        )

    def cut(self, targets: Collection[Port]) -> None:
        """Remove the links to `targets`."""
        links = "link" if len(set(targets)) == 1 else "links"
        self.edit(f"Cut {len(set(targets))} {links}", wiring.cut_links(self.graph, targets))

    def move_link(self, old_target: Port, new_target: Port) -> None:
        """Let the link to one socket feed another instead."""
        self.edit(f"Move link to {new_target}", wiring.move_link(self.graph, old_target, new_target))

    def swap_inputs(self, id: str) -> None:
        """Exchange what feeds the first two inputs of a node."""
        self.edit(f"Swap inputs of {id}", wiring.swap_inputs(self.graph, id))

    def delete(self, heal: bool = True) -> None:
        """Remove what is selected; with `heal`, what fed a node then feeds what it fed, where that fits."""
        if not self.selection:
            raise GraphError("nothing is selected: select what to delete")
        self.edit(
            f"Delete {naming.describe_elements(self.selection)}",
            deleting.delete_elements(self.graph, self.selection, heal),
            (),
        )

    def extract(self, merge: str = "") -> None:
        """Take the selected nodes out of their chains; the links there are healed."""
        after = wiring.extract_nodes(self.graph, self._some_nodes("extract"))
        self.edit(f"Extract {naming.describe_elements(self.selection)}", after, merge=merge)

    def replace(self, id: str, type_id: str) -> None:
        """Give a node another type; links and values stay where they fit."""
        kind = type(self._new(type_id))
        self.edit(f"Replace {id} by {type_id}", wiring.replace_node(self.graph, id, kind))

    def rename(self, id: str, new: str) -> None:
        """Give a node another id; everything that names it follows."""
        graph = self.graph.rename(id, new)
        chosen = [new if key == id else key for key in self._ordered_selection()]
        self._renamed(id, new)
        self.edit(f"Rename {id} to {new}", graph, chosen)

    def mute(self) -> None:
        """Mute the selected nodes; if all are muted already, let them work again."""
        ids = self._some_nodes("mute")
        on = not self.graph.muted.issuperset(ids)
        graph = self.graph
        for id in ids:
            graph = graph.mute(id, on)
        self.edit(f"{'Mute' if on else 'Unmute'} {naming.describe_elements(self.selection)}", graph)

    def collapse(self) -> None:
        """Fold the selected nodes to their title; if all are, unfold them."""
        some = [key for key in self.elements if key in self.selection and elements.can_be_linked(key, self.graph)]
        if not some:
            raise GraphError("no node is selected: select what to collapse")
        on = not all(elements.entry(self.graph, key).get("collapsed") is True for key in some)
        facts: dict[str, Mapping[str, object]] = {key: {"collapsed": True if on else None} for key in some}
        label = f"{'Collapse' if on else 'Expand'} {naming.describe_elements(some)}"
        self.edit(label, elements.with_entries(self.graph, facts))

    def drop_files(self, paths: Sequence[str | Path], at: Place = (0.0, 0.0)) -> tuple[str, ...]:
        """Files from outside as nodes: graphs become groups, shaders code, renders `read_render`, others `read_image`.

        Returns their ids.
        """
        graph, ids = self.graph, list[str]()
        if not paths:
            return ()
        for number, path in enumerate(paths):
            id = graph.fresh_id(naming.node_stem(path))
            spot = (at[0], at[1] + number * DROP_STEP)
            graph = elements.with_places(graph.add(id, self._dropped(path)), {id: spot})
            ids.append(id)
        what = naming.node_stem(paths[0]) if len(ids) == 1 else f"{len(ids)} files"
        self.edit(f"Drop {what}", graph, ids)
        return tuple(ids)

    def add_matte(self, id: str, kind: str = "") -> str:
        """A node that cuts out of the render that another one reads, beside it; returns its id."""
        made = self._new("cryptomatte")
        path = self.graph.value(Port(id, "path"))
        made = made.with_values(path=path, **({"layer": kind} if kind else {}))
        x, y = self.positions[id]
        return self._add("cryptomatte", made, (x, y - ABOVE), None, True)

    def relative(self, path: str | Path) -> str:
        """How the document names a file: relative if it lies below the document's folder, else absolute."""
        return paths.relative(path, self.root.folder)

    # --- inside ----------------------------------------------------------------------------------------------------

    def _add(self, stem: str, item: Item, at: Place, link: Port | None, output: bool) -> str:
        id = self.graph.fresh_id(stem)
        graph: Graph = elements.with_places(self.graph.add(id, item), {id: at})
        if link is not None:
            graph = wiring.link_node(graph, id, link, output)
        self.edit(f"Add {id}", graph, (id,))
        return id

    def _new(self, type_id: str) -> Node:
        if type_id == coding.CODE:
            return coding.make_starter_node()
        if type_id not in self.types:
            raise GraphError(f"there is no node type '{type_id}'{did_you_mean(type_id, self.types)}")
        return self.types[type_id]()

    def _group(self, path: str | Path) -> Group:
        """A graph file as an item, which must not hold this document.

        Presets become part of the document, without their sample pictures: it is not to depend on where Halation is.
        """
        body = load(path, self.types)
        here = self.path.resolve() if self.path else None
        if here in {Path(path).resolve(), *(file.resolve() for file in paths.group_files(body))}:
            raise GraphError(f"a group cannot hold itself: '{Path(path).name}' is or holds this document")
        if Path(path).resolve() in {preset.resolve() for preset in preset_paths()}:
            return Group(paths.rebased(without_samples(body), self.root.folder))
        return Group(body, self.relative(path))

    def _dropped(self, path: str | Path) -> Item:
        if Path(path).suffix.lower() == ".json":
            return self._group(path)
        if Path(path).suffix.lower() in coding.ENDINGS:
            return coding.make_file_node(self.relative(path), self.root.folder)
        type_id = (
            "read_render"
            if "read_render" in self.types and is_render(representative_file(Path(path)))
            else "read_image"
        )
        return self._new(type_id).with_values(path=self.relative(path))

    def _middle(self, target: Port) -> Place:
        """Halfway between the ends of a link."""
        ends = [elements.element_of(end) for end in (target, self.graph.links.get(target, target))]
        spots = [self.positions.get(key, (0.0, 0.0)) for key in ends]
        return (spots[0][0] + spots[1][0]) / 2.0, (spots[0][1] + spots[1][1]) / 2.0

    def _some_nodes(self, verb: str) -> tuple[str, ...]:
        if ids := self._chosen_nodes():
            return ids
        raise GraphError(f"no node is selected: select what to {verb}")


def _stem(type_id: str) -> str:
    """What a new node of a type is called."""
    return "code" if type_id == coding.CODE else type_id.rpartition(".")[2]

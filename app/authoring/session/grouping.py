"""Groups: made, opened, entered and saved."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ...document import save
from ...errors import GraphError, UsageError
from ...graph import Group
from ..edits import folding, grouping, naming, paths, ungrouping
from ..state.history import Snapshot
from .state import State


class Grouping(State):
    """Graphs inside graphs."""

    @property
    def crumbs(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """The way to where someone is: title and place of the document and of every group entered."""
        return ((self.name, ()), *((id, self.place[:depth]) for depth, id in enumerate(self.place, 1)))

    @property
    def borrowed(self) -> str:
        """The file that the graph at `place` belongs to, if it is not this document; it cannot be edited here."""
        found = folding.find_borrowed_group(self.root, self.place)
        return found[1] if found else ""

    def make_group(self, name: str = "") -> str:
        """Turn the selection into a group; returns its id. Raises GraphError if it would feed itself."""
        graph, id = grouping.make_group(self.graph, self.selection, name)
        self.edit(f"Group {naming.describe_elements(self.selection)}", graph, (id,))
        return id

    def ungroup(self, id: str) -> None:
        """Put what is in a group in its place."""
        graph, put = ungrouping.ungroup(self.graph, id)
        self.edit(f"Ungroup {id}", graph, put)

    def enter(self, id: str) -> None:
        """Show what is in a group."""
        folding.find_group(self.graph, id)
        self.go((*self.place, id))

    def leave(self, levels: int = 1) -> None:
        """Show the graph that the group is in, with the group selected."""
        self.go(self.place[: max(len(self.place) - levels, 0)])

    def go(self, place: tuple[str, ...]) -> None:
        """Show the graph at `place`. Raises GraphError if there is none."""
        folding.body_at(self.root, place)
        if place == self.place:
            return
        self.seal()
        left = self.place[len(place)] if self.place[: len(place)] == place else ""
        self._set(Snapshot(self.root, place, frozenset({left} if left else ()), left))

    def make_local(self, id: str) -> None:
        """Make the body of a group that comes from a file part of this document."""
        item = folding.find_group(self.graph, id)
        if not item.path:
            raise GraphError(f"group '{id}' is part of this document already")
        local = Group(paths.rebased(item.body(), self.graph.folder))
        self.edit(f"Make {id} local", replace(self.graph, nodes={**self.graph.nodes, id: local}))

    def save_group(self, id: str, path: str | Path, link: bool = False) -> None:
        """Save what is in a group as a graph file; with `link`, the group comes from that file from now on."""
        target = Path(path)
        body = paths.rebased(folding.find_group(self.graph, id).body(), str(target.parent))
        paths.check_target(body, target)
        if self.path and self.path.resolve() == target.resolve():
            raise UsageError(f"{target}: this is the file of the document itself: choose another name")
        save(body, target)
        if link:
            self.edit(
                f"Link {id} to {target.name}",
                replace(
                    self.graph, nodes={**self.graph.nodes, id: Group(body, paths.relative(target, self.root.folder))}
                ),
            )

"""The open document as commands and panels read it: questions, no changes.

`OpenDocument` answers what the document is (`root`), where in it the user is (`place`, and the `graph` there), what is
selected, and what follows from that: positions, problems, values at the current frame. Answers are computed once per
graph, so panels may ask in every frame of the window. `Session`, which extends it, is the only one that changes it.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Literal

from halation.nodes import Node, Plain, catalogue

from ...custom_nodes import Code
from ...document import load
from ...errors import GraphError, HalationError
from ...graph import (
    ANIMATED,
    INPUTS,
    Animation,
    Expression,
    Graph,
    Group,
    Key,
    Keys,
    Port,
    Problem,
    Settings,
    animation_fault,
    find_key_range,
    value_at,
)
from ...graph.graph import find_value
from ...resources.sandbox import Sandbox
from ..edits import clipboard, coding, decor, elements, folding, layout, paths, wiring
from ..edits.element_id import ElementId
from ..edits.elements import Place, Places, Sizes
from ..edits.folding import GroupPath
from ..edits.key_frames import list_key_frames, whole_key_frames
from ..edits.ports import default_view, is_viewable, list_numbered_ports
from ..edits.values import reset_value
from .history import History, Snapshot
from .memo import Memo
from .problems import find_problems, sort_problems

Measure = Callable[[Graph, Mapping[str, str]], tuple[int, int]]
"""The first and last frame of a graph with files bound to its inputs."""

Side = Literal["A", "B"]
"""The two sides of the viewer."""

MAX_FRAME = 1_000_000
"""Frames further from 0 than that are a typing error: at 24 frames per second this is more than eleven hours."""


class OpenDocument:
    """A document, where in it the user is, what is selected, and what can be undone.

    `types` are the node types by id, by default all that are installed. `sandbox` says which files may be read and
    written. `measure` finds the frame range of a graph that
    does not state one; without it only keys count.
    """

    def __init__(self, types: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> None:
        self._types, self.sandbox = types, sandbox
        self.history = History()
        self.path: Path | None = None
        self.measure: Measure | None = None
        self._title = ""
        self._snapshot = Snapshot(Graph())
        self._saved: Graph | None = self._snapshot.root
        self._bound: dict[str, str] = {}
        self._frame: int | None = None
        self._views: dict[tuple[GroupPath, Side], tuple[Port, ...]] = {}
        self._memo = Memo()
        self._offered_groups: dict[Path, Group] = {}

    # --- the document ------------------------------------------------------------------------------------------------

    @property
    def types(self) -> Mapping[str, type[Node]]:
        """The node types that there are, by id."""
        return catalogue() if self._types is None else self._types

    @property
    def root(self) -> Graph:
        """The whole document."""
        return self._snapshot.root

    @property
    def place(self) -> GroupPath:
        """The groups entered, outermost first."""
        return self._snapshot.place

    @property
    def selection(self) -> frozenset[ElementId]:
        """The selected elements."""
        return self._snapshot.selection

    @property
    def active(self) -> ElementId:
        """The element selected last; empty if there is none."""
        return self._snapshot.active

    @property
    def ordered_selection(self) -> list[ElementId]:
        """The selected elements, the active one last."""
        return [*sorted(self.selection - {self.active}), *([self.active] if self.active else [])]

    @property
    def graph(self) -> Graph:
        """The graph at `place`, with the values that groups set; every element of it has a place on the canvas."""
        source, before = (self.root, self.place), self._memo.last("graph")[1]
        return self._memo.get("graph", source, lambda: layout.pin_places(folding.body_at(*source), before))

    @property
    def positions(self) -> Places:
        """Where every element of `graph` lies."""
        return self._memo.get("positions", (self.graph.ui, self.elements), lambda: layout.positions(self.graph))

    @property
    def elements(self) -> tuple[ElementId, ...]:
        """All elements of `graph`; the same object until they change."""
        return self._memo.get("elements", (self.graph,), self._list_elements)

    def position(self, element: ElementId) -> Place:
        """Where an element lies. Raises GraphError if there is none."""
        if element not in self.positions:
            raise GraphError(f"there is no '{element}' on the canvas")
        return self.positions[element]

    def frame_members(self, frame: ElementId, sizes: Sizes | None = None) -> frozenset[ElementId]:
        """The elements inside a frame."""
        return decor.find_frame_members(self.graph, frame, self.positions, sizes)

    @property
    def folder(self) -> Path:
        """The folder where relative paths of the document start."""
        return Path(self.root.folder)

    def relative(self, path: str | Path) -> str:
        """How the document names a file: relative if it lies below the document's folder, else absolute."""
        return paths.relative(path, self.root.folder)

    @property
    def name(self) -> str:
        """What the document is called."""
        return self.path.stem if self.path else self._title or "untitled"

    @property
    def crumbs(self) -> tuple[tuple[str, GroupPath], ...]:
        """The way to where the user is: title and place of the document and of every group entered."""
        return ((self.name, ()), *((id, self.place[:depth]) for depth, id in enumerate(self.place, 1)))

    @property
    def borrowed(self) -> str:
        """The file that the graph at `place` belongs to, if it is not this document; it cannot be edited here."""
        borrowed = folding.find_borrowed_group(self.root, self.place)
        return borrowed[1] if borrowed else ""

    def check_editable(self) -> None:
        """Raise GraphError within a group that comes from another file."""
        if borrowed := folding.find_borrowed_group(self.root, self.place):
            group, file = borrowed[0][-1], borrowed[1]
            raise GraphError(f"group '{group}' comes from the file '{file}': make it local first, or open that file")

    @property
    def dirty(self) -> bool:
        """True if the document differs from what was saved."""
        is_same = self.root is self._saved
        return not is_same and self._memo.get("dirty", (self.root, self._saved), lambda: self.root != self._saved)

    @property
    def all_problems(self) -> tuple[Problem, ...]:
        """Everything that is wrong with the document, groups included."""
        return find_problems(self._memo, "all problems", self.root, self.types)

    @property
    def problems(self) -> Mapping[ElementId, tuple[Problem, ...]]:
        """What is wrong with `graph`, by element; what belongs to none is under the empty id."""
        problems = find_problems(self._memo, "problems", self.graph, self.types) if self.place else self.all_problems
        return self._memo.get(
            "problems by element", (problems, self.elements), lambda: sort_problems(problems, self.elements)
        )

    @property
    def bindings(self) -> Mapping[str, str]:
        """Files that inputs of the document are bound to; they are not saved."""
        return {name: file for name, file in self._bound.items() if name in self.root.inputs}

    def copy(self) -> str:
        """The selection as text. Raises GraphError if there is none."""
        if not self.selection:
            raise GraphError("nothing is selected: select what to copy")
        return clipboard.copy_elements(self.graph, self.selection)

    # --- links -------------------------------------------------------------------------------------------------------

    def find_source(self, port: Port) -> Port | None:
        """The port that feeds an input or value, if any."""
        return self.graph.links.get(port)

    def refusal(self, source: Port, target: Port) -> str | None:
        """Why a link is impossible, or None."""
        return wiring.why_not_linkable(self.graph, source, target)

    def list_fitting_types(self, port: Port, is_output: bool) -> tuple[str, ...]:
        """Ids of the node types that could be linked with `port`, a source if `is_output`."""
        return wiring.list_fitting_types(self.graph, port, is_output, coding.with_code_type(self.types))

    def fits_picture(self, port: Port, is_output: bool) -> bool:
        """True if a port could be linked with a picture, as a source if `is_output`."""
        return wiring.fits_picture(self.graph, port, is_output)

    def list_fitting_files(self, files: Sequence[Path], port: Port, is_output: bool) -> tuple[Path, ...]:
        """Those of some graph files that could, as groups, be linked with `port`, a source if `is_output`."""
        groups = self._offered_groups
        groups |= {file: Group(load(file, self.types, sandbox=self.sandbox)) for file in files if file not in groups}
        return tuple(file for file in files if wiring.fits(self.graph, port, is_output, groups[file]))

    # --- values ------------------------------------------------------------------------------------------------------

    def value(self, port: Port) -> Plain:
        """What a value of a node, or a control of a group, is set to, without its animation."""
        return self.graph.value(port)

    def is_default(self, port: Port) -> bool:
        """True if a value is as it is in a new node, at all frames."""
        is_still = port not in self.graph.animation
        return is_still and self.graph.value(port) == reset_value(self.graph, port).value(port)

    def control_of(self, port: Port) -> str | None:
        """The control that shows a value, if any."""
        return next((name for name, item in self.graph.controls.items() if item.target == port), None)

    def code(self, id: str) -> Code | None:
        """The code of a node; None for nodes that are made of none."""
        return coding.read_node_code(self.graph.nodes.get(id), self.graph.folder, sandbox=self.sandbox)

    def code_in_file(self, id: str) -> Code:
        """The code of a node whose code is in a file. Raises GraphError for other nodes."""
        code = self.code(id)
        if code is None or not code.file:
            raise GraphError(f"the code of node '{id}' is in no file")
        return code

    # --- time --------------------------------------------------------------------------------------------------------

    @property
    def frame(self) -> int:
        """The current frame, at first the first one: no part of the document."""
        return self.frames[0] if self._frame is None else self._frame

    @property
    def frames(self) -> tuple[int, int]:
        """The first and last frame: as the document says, else those of the first sequence it reads, else of keys."""
        stated = self.root.settings.frames
        return stated or self._memo.get("frames", (self.root, *self.bindings.values()), self._measure_frames)

    @property
    def settings(self) -> Settings:
        """What holds for the document as a whole, in groups too."""
        return self.root.settings

    def can_animate(self, port: Port) -> bool:
        """True if the value can change over time."""
        try:
            return find_value(self.graph.node(port.node), port.socket, port.node).type in ANIMATED
        except GraphError:
            return False

    def animation(self, port: Port) -> Animation | None:
        """How a value changes over time, if it does."""
        return self.graph.animation.get(port)

    def key_at(self, port: Port, frame: float | None = None) -> Key | None:
        """The key of a value at a frame, by default the current one."""
        keys = self.animation(port)
        return keys.key(self.frame if frame is None else frame) if isinstance(keys, Keys) else None

    def value_now(self, port: Port) -> Plain:
        """What a value is at the current frame. Raises GraphError for an expression that has no value."""
        return self.value_then(port, self.frame)

    def value_then(self, port: Port, frame: int) -> Plain:
        """What a value is at a frame. Raises GraphError."""
        outer = self.find_outer_animation(port)
        if outer is not None:
            return value_at(self._graph_with_settings(outer[0]), outer[1], frame)
        return value_at(self._graph_with_settings(self.place), port, frame)

    @property
    def graph_now(self) -> Graph:
        """`graph` with every value as it is at the current frame; what has no value then stays as it is."""
        exposed = [control.target for control in self.graph.controls.values()] if self.place else []
        if not self.graph.animation and not any(map(self.find_outer_animation, exposed)):
            return self.graph
        source = (self.root, self.graph, self.frame)
        return self._memo.get("graph now", source, lambda: self._evaluate_now(exposed))

    def find_outer_animation(self, port: Port) -> tuple[GroupPath, Port] | None:
        """Where a value of a group's body is animated as a control of the group: the place outside, and its port."""
        outermost, place = None, self.place
        graph = self.graph
        while place:
            name = next((name for name, control in graph.controls.items() if control.target == port), None)
            if name is None:
                break
            place, port = place[:-1], Port(place[-1], name)
            graph = self._graph_with_settings(place)
            if port in graph.animation:
                outermost = place, port
        return outermost

    def expression_fault(self, port: Port, text: str) -> str | None:
        """Why a value cannot follow an expression, with a caret below its text, or None."""
        return animation_fault(self.graph, port, Expression(text.strip().removeprefix("=").strip()))

    def key_frames(self, port: Port | None = None) -> tuple[int, ...]:
        """Frames with keys of a value; without one, of the selected nodes, else of all that the graph has."""
        if port is not None:
            return whole_key_frames(self.graph.animation.get(port))
        source = (self.graph, self.selection)
        return self._memo.get("key frames", source, lambda: list_key_frames(*source))

    def next_key(self, port: Port | None = None) -> int | None:
        """The next frame with a key, as `key_frames` finds them."""
        frames = self.key_frames(port)
        index = bisect_right(frames, self.frame)
        return frames[index] if index < len(frames) else None

    def previous_key(self, port: Port | None = None) -> int | None:
        """The frame with a key before this one."""
        frames = self.key_frames(port)
        index = bisect_left(frames, self.frame) - 1
        return frames[index] if index >= 0 else None

    # --- the viewer --------------------------------------------------------------------------------------------------

    def find_viewed_port(self, side: Side = "A") -> Port | None:
        """The port of `graph` that a side of the viewer shows. Every graph, groups too, has its own.

        A port that vanished comes back with it. Meanwhile, and where nobody chose one, A shows the first output of
        the graph, else the last node, and B nothing.
        """
        chosen = self._views.get((self.place, side), ())
        port = next((port for port in chosen if is_viewable(self.graph, port)), None)
        if port is None and side == "A":
            return self._memo.get("default view", (self.graph,), lambda: default_view(self.graph))
        return port

    def find_viewed_root_port(self, side: Side = "A") -> Port | None:
        """The same port as the document calls it, groups on the way included: `glow/blur.out`."""
        port, place = self.find_viewed_port(side), self.place
        while port and port.node == INPUTS and place:
            outer = folding.body_at(self.root, place[:-1]).links.get(Port(place[-1], port.socket))
            if outer is None:
                break
            port, place = outer, place[:-1]
        return port and Port("/".join((*place, port.node)), port.socket)

    @property
    def viewers(self) -> Mapping[int, Port]:
        """The ports that keys 1 to 9 recall."""
        return list_numbered_ports(self.graph)

    # --- inside ------------------------------------------------------------------------------------------------------

    def _list_elements(self) -> tuple[ElementId, ...]:
        """The same tuple as before where the elements are the same, so that what is computed of it stays."""
        keys, before = elements.list_elements(self.graph), self._memo.last("elements")[1]
        return before if keys == before else keys

    def _graph_with_settings(self, place: GroupPath) -> Graph:
        """The graph at a place, with the rate and range of the document."""

        def compute() -> Graph:
            graph = self.graph if place == self.place else folding.body_at(self.root, place)
            return replace(graph, settings=self.settings)

        return self._memo.get(f"timed {len(place)}", (self.root, self.graph), compute)

    def _evaluate_now(self, exposed: Iterable[Port]) -> Graph:
        graph, changed = self.graph, dict[Port, Plain]()
        for port in dict.fromkeys((*graph.animation, *exposed)):
            with suppress(GraphError):
                if (plain := self.value_now(port)) != graph.value(port):
                    changed[port] = plain
        return graph.put_all(changed)

    def _measure_frames(self) -> tuple[int, int]:
        if self.measure is not None:
            with suppress(HalationError):
                return self.measure(self.root, self.bindings)
        return find_key_range(self.root)

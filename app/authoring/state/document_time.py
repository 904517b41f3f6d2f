"""The current frame of a document, its frame range, and what its values are over time."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace

from halation.nodes import Plain

from ...errors import GraphError, HalationError
from ...graph import Graph, Key, Keys, Port, find_key_range, value_at
from ...graph.keys import round_keys
from ...graph.spline_points import split_point
from ..edits import folding
from ..edits.folding import GroupPath
from ..edits.key_frames import list_key_frames, whole_key_frames
from .document_state import DocumentState
from .memo import Memo

MeasureFrames = Callable[[Graph, Mapping[str, str]], tuple[int, int]]
"""Finds the first and last frame of a graph with files bound to its inputs."""

MAX_FRAME = 1_000_000
"""Frames further from 0 than that are a typing error: at 24 frames per second this is more than eleven hours."""


class DocumentTime:
    """The time of a document. The current frame is no part of the document; keys and the frame range are.

    `measure_frames` finds the range of a graph that does not state one; without it only keys count.
    """

    def __init__(self, document: DocumentState) -> None:
        self._document = document
        self._frame: int | None = None
        self._memo = Memo()
        self.measure_frames: MeasureFrames | None = None

    @property
    def frame(self) -> int:
        """The current frame; in a document that was just opened the first one."""
        return self.frames[0] if self._frame is None else self._frame

    @property
    def frames(self) -> tuple[int, int]:
        """The first and last frame: as the document says, else those of the first sequence it reads, else of keys."""
        document = self._document
        source = (document.root, *document.bindings.values())
        return document.root.settings.frames or self._memo.get("frames", source, self._measure)

    def seek(self, frame: float) -> None:
        """Make a frame the current one; it may lie outside of the range."""
        self._frame = min(max(round_keys(frame), -MAX_FRAME), MAX_FRAME)

    def remeasure(self) -> None:
        """Find the frame range again, because files have changed."""
        self._memo.forget("frames")

    def reset(self) -> None:
        """Go to the first frame: another document is open."""
        self._frame = None
        self._memo.clear()

    def evaluate(self, port: Port, frame: int | None = None) -> Plain:
        """What a value is at a frame, by default the current one. Raises GraphError if an expression has no value."""
        place, port = self.find_outer_animation(port) or (self._document.place, port)
        return value_at(self._graph_with_settings(place), port, self.frame if frame is None else frame)

    @property
    def evaluated_graph(self) -> Graph:
        """The current graph with every value as it is at the current frame; a value that has none then stays as set."""
        document = self._document
        exposed = [control.target for control in document.graph.controls.values()] if document.place else []
        if not document.graph.animation and not any(map(self.find_outer_animation, exposed)):
            return document.graph
        source = (document.root, document.graph, self.frame)
        return self._memo.get("evaluated graph", source, lambda: self._evaluate_all(exposed))

    def find_outer_animation(self, port: Port) -> tuple[GroupPath, Port] | None:
        """Where a value of a group's body is animated as a control of the group: the place outside, and its port."""
        outermost, place = None, self._document.place
        graph = self._document.graph
        while place:
            name = next((name for name, control in graph.controls.items() if control.target == port), None)
            if name is None:
                break
            place, port = place[:-1], Port(place[-1], name)
            graph = self._graph_with_settings(place)
            if port in graph.animation:
                outermost = place, port
        return outermost

    def find_key(self, port: Port, frame: float | None = None) -> Key | None:
        """The key of a value at a frame, by default the current one."""
        keys = self._document.graph.animation.get(port)
        return keys.key(self.frame if frame is None else frame) if isinstance(keys, Keys) else None

    def list_key_frames(self, port: Port | None = None) -> tuple[int, ...]:
        """Frames with keys of a value; without one, of the selected nodes, else of all nodes."""
        document = self._document
        if port is not None:
            return whole_key_frames(document.graph.animation.get(port))
        source = (document.graph, document.selection)
        return self._memo.get("key frames", source, lambda: list_key_frames(*source))

    def find_next_key(self, port: Port | None = None) -> int | None:
        """The next frame with a key, of those that `list_key_frames` gives."""
        frames = self.list_key_frames(port)
        index = bisect_right(frames, self.frame)
        return frames[index] if index < len(frames) else None

    def find_previous_key(self, port: Port | None = None) -> int | None:
        """The last frame with a key before the current one."""
        frames = self.list_key_frames(port)
        index = bisect_left(frames, self.frame) - 1
        return frames[index] if index >= 0 else None

    def _graph_with_settings(self, place: GroupPath) -> Graph:
        """The graph at a place, with the rate and range of the document."""
        document = self._document

        def compute() -> Graph:
            graph = document.graph if place == document.place else folding.body_at(document.root, place)
            return replace(graph, settings=document.root.settings)

        return self._memo.get(f"graph {len(place)}", (document.root, document.graph), compute)

    def _evaluate_all(self, exposed: Iterable[Port]) -> Graph:
        graph, changed = self._document.graph, dict[Port, Plain]()
        for port in dict.fromkeys((*graph.animation, *exposed)):
            with suppress(GraphError):
                plain = self.evaluate(port)
                if split_point(port.socket) or plain != graph.value(port):  # a point is set after the whole spline
                    changed[port] = plain
        return graph.put_all(changed)

    def _measure(self) -> tuple[int, int]:
        if self.measure_frames is not None:
            with suppress(HalationError):
                return self.measure_frames(self._document.root, self._document.bindings)
        return find_key_range(self._document.root)

"""Time: the frame that is looked at, and values that change over it."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from halation.nodes import ColorSettings, Plain

from ...errors import GraphError, HalationError
from ...graph import (
    ANIMATED,
    Animation,
    Expression,
    Graph,
    Key,
    Keys,
    Port,
    Settings,
    animation_fault,
    find_key_range,
    signature,
    value_at,
)
from ...graph.graph import declared
from ...graph.keys import round_keys
from ..edits.elements import clean_text
from ..edits.folding import GroupPath, body_at
from ..state.history import Snapshot
from .state import State

Measure = Callable[[Graph, Mapping[str, str]], tuple[int, int]]
"""The first and last frame of a graph with files bound to its inputs."""

MOST = 1_000_000
"""Frames further from 0 than that are a slip of the hand."""


class Animating(State):
    """Which frame is looked at, which frames there are, keys and expressions.

    Ports are those of `graph`; range, rate and pre-roll are the document's, in groups too. `measure` finds the range
    of a graph that does not state one; without it only keys count.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.measure: Measure | None = None
        self._frame: int | None = None

    # --- frames ------------------------------------------------------------------------------------------------------

    @property
    def frame(self) -> int:
        """The frame that is looked at: no part of the document. At first the first one."""
        return self.frames[0] if self._frame is None else self._frame

    def seek(self, frame: float) -> None:
        """Look at a frame; it may lie outside of the range."""
        wanted = min(max(round_keys(frame), -MOST), MOST)
        if wanted != self._frame:
            self._frame = wanted

    @property
    def frames(self) -> tuple[int, int]:
        """The first and last frame: as the document says, else those of the first sequence it reads, else of keys."""
        stated = self.root.settings.frames
        return stated or self._kept("frames", (self.root, *self.bindings.values()), self._measured)

    def look_again(self) -> None:
        """Find the range anew: files have changed."""
        self._cache.pop("frames", None)

    @property
    def settings(self) -> Settings:
        """What holds for the document as a whole."""
        return self.root.settings

    def set_frames(self, first: int | None, last: int | None = None, merge: str = "") -> None:
        """State the range of the document; None leaves it to what the graph reads."""
        frames = None if first is None else (int(first), int(first if last is None else last))
        if frames and frames[0] > frames[1]:
            raise GraphError(f"the first frame, {frames[0]}, comes after the last one, {frames[1]}")
        if frames and max(map(abs, frames)) > MOST:
            raise GraphError(f"frames go from {-MOST} to {MOST}")
        self._set_settings("Set frames", replace(self.settings, frames=frames), merge)

    def set_rate(self, rate: float, merge: str = "") -> None:
        """Set the frames per second."""
        if not 0.01 <= rate <= 1000.0:
            raise GraphError(f"{rate:g} frames per second: give 0.01 to 1000")
        self._set_settings("Set rate", replace(self.settings, rate=float(rate)), merge)

    def set_preroll(self, preroll: int | None, merge: str = "") -> None:
        """Set how many frames nodes with a memory look back; None: to the first frame."""
        if preroll is not None and not 0 <= preroll <= MOST:
            raise GraphError(f"a pre-roll of {preroll} frames: give 0 or more")
        self._set_settings("Set pre-roll", replace(self.settings, preroll=preroll), merge)

    def set_color(self, *, config: str | None = None, working: str | None = None, merge: str = "") -> None:
        """Set where color spaces come from, or the one to work in; what is not given stays."""
        now = self.settings.color
        color = ColorSettings(now.config if config is None else config, now.working if working is None else working)
        self._set_settings("Set color", replace(self.settings, color=color), merge)

    # --- values ------------------------------------------------------------------------------------------------------

    def can_animate(self, port: Port) -> bool:
        """True if the value can change over time."""
        try:
            return declared(self.graph.node(port.node), port.socket, port.node).type in ANIMATED
        except GraphError:
            return False

    def animation(self, port: Port) -> Animation | None:
        """How a value changes over time, if it does."""
        return self.graph.animation.get(port)

    def key_at(self, port: Port, frame: float | None = None) -> Key | None:
        """The key of a value at a frame, by default the one that is looked at."""
        keys = self.animation(port)
        return keys.key(self.frame if frame is None else frame) if isinstance(keys, Keys) else None

    def value_now(self, port: Port) -> Plain:
        """What a value is at the frame that is looked at. Raises GraphError for an expression that has no value."""
        return self.value_then(port, self.frame)

    def value_then(self, port: Port, frame: int) -> Plain:
        """What a value is at a frame. Raises GraphError."""
        outer = self.animated_outside(port)
        if outer is not None:
            return value_at(self._timed(outer[0]), outer[1], frame)
        return value_at(self._timed(self.place), port, frame)

    @property
    def graph_now(self) -> Graph:
        """`graph` with every value as it is at the frame that is looked at; what has no value then stays as it is."""
        shown = [control.target for control in self.graph.controls.values()] if self.place else []
        if not self.graph.animation and not any(map(self.animated_outside, shown)):
            return self.graph
        return self._kept("graph now", (self.root, self.graph, self.frame), lambda: self._at_now(shown))

    def animated_outside(self, port: Port) -> tuple[GroupPath, Port] | None:
        """Where a value of a group's body is animated as a control of the group: the place outside, and its port."""
        found, place = None, self.place
        graph = self.graph
        while place:
            name = next((name for name, control in graph.controls.items() if control.target == port), None)
            if name is None:
                break
            place, port = place[:-1], Port(place[-1], name)
            graph = self._timed(place)
            if port in graph.animation:
                found = place, port
        return found

    # --- changes -----------------------------------------------------------------------------------------------------

    def key(self, port: Port, value: object = None, merge: str = "") -> None:
        """Set a key at the frame that is looked at: of what the value is now, unless another is given."""
        self._check_inside(port)
        before = self.animation(port)
        if isinstance(before, Expression):
            raise GraphError(f"{port} follows an expression: bake it into keys, or remove it first")
        keys = before or Keys()
        if value is None:
            made = keys.insert(self.frame) if keys.keys else keys.set(self.frame, self.value_now(port))
        else:
            made = keys.set(self.frame, _plain(value))
        self.animate(port, made, f"Key {port}", merge)

    def unkey(self, port: Port) -> None:
        """Remove the key of the frame that is looked at. After the last one the value stays as it is."""
        keys = self.animation(port)
        if not isinstance(keys, Keys) or keys.key(self.frame) is None:
            raise GraphError(f"{port} has no key at frame {self.frame}")
        left = keys.remove(self.frame)
        self.animate(port, left if left.keys else None, f"Remove a key of {port}")

    def toggle_key(self, port: Port) -> None:
        """Set or remove the key of the frame that is looked at."""
        if self.key_at(port) is None:
            self.key(port)
        else:
            self.unkey(port)

    def animate(self, port: Port, animation: Animation | None, label: str, merge: str = "") -> None:
        """Let a value change over time; None lets it stay as it is now, if that can be told."""
        self.animate_all({port: animation}, label, merge)

    def animate_all(self, animations: Mapping[Port, Animation | None], label: str, merge: str = "") -> None:
        """The same for several values, as one step."""
        graph = self.graph
        for port, animation in animations.items():
            if animation is not None and not (isinstance(animation, Keys) and not animation.keys):
                graph = graph.animate(port, animation)
            elif port in graph.animation:
                graph = self._stilled(graph, port)
        self.edit(label, graph, merge=merge)

    def express(self, port: Port, text: str, merge: str = "") -> None:
        """Let a value follow an expression; a `=` in front does not count. Without text it stays as it is now."""
        self._check_inside(port)
        text = clean_text(text).strip().removeprefix("=").strip()
        if text and (fault := self.expression_fault(port, text)):
            raise GraphError(fault)
        self.animate(port, Expression(text) if text else None, f"Expression of {port}", merge)

    def expression_fault(self, port: Port, text: str) -> str | None:
        """Why a value cannot follow an expression, with a caret below its text, or None."""
        return animation_fault(self.graph, port, Expression(text.strip().removeprefix("=").strip()))

    def bake(self, port: Port, frames: Iterable[int] | None = None) -> None:
        """Turn what a value is at each of these frames, by default of the whole range, into keys."""
        self._check_inside(port)
        chosen = tuple(range(self.frames[0], self.frames[1] + 1) if frames is None else frames)
        if not chosen:
            raise GraphError(f"{port}: there are no frames to bake")
        values = {frame: self.value_then(port, frame) for frame in chosen}
        keys = (Key(frame, item, "constant" if isinstance(item, bool) else "linear") for frame, item in values.items())
        self.animate(port, Keys(tuple(keys)), f"Bake {port}")

    # --- jumping -----------------------------------------------------------------------------------------------------

    def key_frames(self, port: Port | None = None) -> tuple[int, ...]:
        """Frames with keys of a value; without one, of the selected nodes, else of all that the graph has."""
        animation = self.graph.animation
        if port is not None:
            return _whole(animation.get(port))
        selection = self.selection
        return self._kept(
            "key frames",
            (self.graph, selection),
            lambda: tuple(
                sorted(
                    {*_frames(animation, {id for id in self.graph.nodes if id in selection})}
                    or {*_frames(animation, None)}
                )
            ),
        )

    def next_key(self, port: Port | None = None) -> int | None:
        """The next frame with a key, as `key_frames` finds them."""
        frames = self.key_frames(port)
        place = bisect_right(frames, self.frame)
        return frames[place] if place < len(frames) else None

    def previous_key(self, port: Port | None = None) -> int | None:
        """The frame with a key before this one."""
        frames = self.key_frames(port)
        place = bisect_left(frames, self.frame) - 1
        return frames[place] if place >= 0 else None

    # --- inside ------------------------------------------------------------------------------------------------------

    def _timed(self, place: GroupPath) -> Graph:
        """The graph at a place, with the rate and range of the document."""
        return self._kept(
            f"timed {len(place)}",
            (self.root, self.graph),
            lambda: replace(self.graph if place == self.place else body_at(self.root, place), settings=self.settings),
        )

    def _at_now(self, shown: Iterable[Port]) -> Graph:
        graph = self.graph
        for port in dict.fromkeys((*graph.animation, *shown)):
            with suppress(GraphError):
                if (plain := self.value_now(port)) != graph.value(port):
                    graph = graph.put(port, plain)
        return graph

    def _measured(self) -> tuple[int, int]:
        if self.measure is not None:
            try:
                return self.measure(self.root, self.bindings)
            except HalationError:
                pass
        return find_key_range(self.root)

    def _set_settings(self, label: str, settings: Settings, merge: str) -> None:
        if settings != self.settings:
            root = replace(self.root, settings=settings)
            self._step(label, Snapshot(root, self.place, self.selection, self.active), merge)

    def _stilled(self, graph: Graph, port: Port) -> Graph:
        """Without the animation of a value, which stays as it is at this frame where it has a value there."""
        try:
            return graph.set(port, self.value_now(port))
        except GraphError:
            return graph.animate(port, None)

    def _check_inside(self, port: Port) -> None:
        if outer := self.animated_outside(port):
            where = "/".join(outer[0]) or "the graph outside"
            raise GraphError(f"{port} is animated as '{outer[1]}' in {where}: change it there")

    def _with_key(self, port: Port, value: object) -> Keys | None:
        """The keys of a value with one at this frame; None if it has none. Raises GraphError for an expression."""
        self._check_inside(port)
        before = self.animation(port)
        if isinstance(before, Expression):
            raise GraphError(f"{port} follows an expression: edit it, or remove it first")
        return before and before.set(self.frame, _plain(value))

    def _restart(self, root: Graph, path: Path | None, saved: Graph | None) -> None:
        self._frame = None
        super()._restart(root, path, saved)


def values_of(graph: Graph, id: str) -> tuple[Port, ...]:
    """The values of a node that can change over time."""
    if id not in graph.nodes:
        return ()
    return tuple(Port(id, name) for name, value in signature(graph.nodes[id]).values.items() if value.type in ANIMATED)


def _plain(value: object) -> Plain:
    if isinstance(value, list | tuple):
        return tuple(float(part) for part in value)
    if isinstance(value, bool | int | float | str):
        return value
    raise GraphError(f"{value!r} cannot be a key")


def _whole(animation: Animation | None) -> tuple[int, ...]:
    frames = animation.frames if isinstance(animation, Keys) else ()
    return tuple(sorted({round_keys(frame) for frame in frames}))


def _frames(animation: Mapping[Port, Animation], nodes: set[str] | None) -> Iterable[int]:
    return (frame for port, item in animation.items() if nodes is None or port.node in nodes for frame in _whole(item))

"""How every node stands in the moment: selected, shown, faulty, slow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ...authoring.edits.elements import element_of
from ...graph import Problem
from .brush import CanvasColors
from .gestures import Gesture, Link
from .paint_node import NodeLook

if TYPE_CHECKING:
    from .context import CanvasContext

SLOW, COSTLY = 0.35, 0.12
"""Shares of the whole time from which a node counts as slow, or worth a look."""


@dataclass(frozen=True)
class Moment:
    """What decides the looks of all nodes in one frame; what is costly to find out is found out once."""

    context: CanvasContext
    ink: CanvasColors
    shown: Mapping[str, str]
    badges: Mapping[str, str]
    lit: Mapping[str, frozenset[tuple[bool, str]]] | None
    costs: Mapping[str, tuple[float, int]]
    total: float
    hot: str
    prefix: str
    selection: frozenset[str]
    active: str
    muted: frozenset[str]
    problems: Mapping[str, tuple[Problem, ...]]
    pictures: bool

    def faults(self, key: str) -> tuple[str, ...]:
        """What keeps an element from rendering."""
        found = tuple(one.sentence for one in self.problems.get(key, ()) if one.severity == "error")
        fault = self.context.preview.faults.get(self.prefix + key, "")
        return (*found, fault) if fault and fault not in found else found

    def warnings(self, key: str) -> tuple[str, ...]:
        """What else is worth a look."""
        return tuple(one.sentence for one in self.problems.get(key, ()) if one.severity == "warning")

    def look(self, key: str, live: frozenset[str]) -> NodeLook:
        """The look of one node or end."""
        faults = self.faults(key)
        warnings = () if faults else self.warnings(key)
        picture, fresh, size = None, True, (1, 1)
        if self.pictures and (found := self.context.preview.thumbnail(self.prefix + key)):
            picture, fresh = imgui.ImTextureRef(found[0].native_handle), found[1]
            size = found[0].size
        overlay, color = self._cost(key)
        return NodeLook(
            selected=key in self.selection,
            active=key == self.active,
            muted=key in self.muted,
            fault=faults[0] if faults else "",
            warning=warnings[0] if warnings else "",
            badges=self.badges.get(key, ""),
            viewed=self.shown.get(key, ""),
            hot=key == self.hot,
            lit=None if self.lit is None else self.lit.get(key, frozenset()),
            picture=picture,
            picture_size=size,
            fresh=fresh,
            live=live,
            overlay=overlay,
            overlay_color=color,
        )

    def _cost(self, key: str) -> tuple[str, int]:
        if key not in self.costs:
            return "", 0
        seconds, size = self.costs[key]
        share = seconds / self.total if self.total else 0.0
        color = self.ink.error if share > SLOW else self.ink.warning if share > COSTLY else self.ink.dim
        return f"{seconds * 1e3:.1f} ms   {_size(size)}", color


def moment(context: CanvasContext, ink: CanvasColors, gesture: Gesture, hot: str) -> Moment:
    """What holds for all nodes in this frame."""
    session = context.session
    shown: dict[str, str] = {}
    for side in ("A", "B"):
        if port := session.viewed(side):
            shown[element_of(port)] = shown.get(element_of(port), "") + side
    badges: dict[str, str] = {}
    for number, port in session.viewers.items():
        badges[element_of(port)] = f"{badges.get(element_of(port), '')} {number}".strip()
    lit: dict[str, frozenset[tuple[bool, str]]] | None = None
    if isinstance(gesture, Link):
        lit = {}
        for port in gesture.targets:
            lit[element_of(port)] = lit.get(element_of(port), frozenset()) | {(not gesture.output, port.socket)}
        lit[element_of(gesture.port)] = frozenset({(gesture.output, gesture.port.socket)})
    costs, total = _costs(context) if context.preview.timed else ({}, 0.0)
    prefix = "".join(f"{id}/" for id in session.place)
    return Moment(
        context,
        ink,
        shown,
        badges,
        lit,
        costs,
        total,
        hot,
        prefix,
        session.selection,
        session.active,
        session.graph.muted,
        session.problems,
        context.preview.thumbnailing,
    )


def _costs(context: CanvasContext) -> tuple[dict[str, tuple[float, int]], float]:
    """Seconds and bytes of every element here, groups with all that is in them, and the seconds of everything."""
    timings = context.preview.timings
    prefix = "".join(f"{id}/" for id in context.session.place)
    found: dict[str, dict[frozenset[str], tuple[float, int]]] = {}
    everything: dict[frozenset[str], float] = {}
    for path, timing in timings.items():
        passes = frozenset({path, *timing.shared})
        everything[passes] = timing.seconds
        if path.startswith(prefix):
            key = path.removeprefix(prefix).partition("/")[0]
            found.setdefault(key, {})[passes] = timing.seconds, timing.bytes
    costs = {
        key: (sum(seconds for seconds, _ in parts.values()), sum(size for _, size in parts.values()))
        for key, parts in found.items()
    }
    return costs, sum(everything.values())


def _size(size: int) -> str:
    return f"{size / 2**20:.1f} MB" if size >= 2**20 else f"{size / 2**10:.0f} KB"

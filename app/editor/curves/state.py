"""What the panel shows and what is chosen in it. Nothing here draws."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from ...graph import Graph, Keys, Port
from ..toolkit.plane import View
from .rows import CurveRow, Spot, rows

Mode = Literal["sheet", "curves"]
Fit = Literal["", "all", "chosen"]


@dataclass
class CurvesState:
    """The Animation panel. Both modes share the view, the rows and the chosen keys."""

    mode: Mode = "sheet"
    view: View = field(default_factory=View)
    wanted: Fit = "all"
    """What is to be brought into view when next drawn."""
    scroll: float = 0.0
    """Pixels that the rows are scrolled."""
    only_selected: bool = False
    """True leaves out the values of nodes that are not selected."""
    snap: bool = True
    """True keeps moved keys on whole frames."""
    spots: frozenset[Spot] = frozenset()
    """The chosen channels of keys."""
    shown: frozenset[Port] = frozenset()
    """The chosen rows: their curves are drawn. None means all."""
    anchor: Port | None = None
    """The row from which Shift extends."""
    folded: set[str] = field(default_factory=set[str])
    hidden: set[tuple[Port, int]] = field(default_factory=set[tuple[Port, int]])
    """Channels without a curve."""
    free: set[tuple[Port, float]] = field(default_factory=set[tuple[Port, float]])
    """Keys whose handles do not turn together."""
    hovered: bool = False
    """True while the mouse is over the panel."""
    _rows: tuple[tuple[object, ...], tuple[CurveRow, ...]] = ((), ())
    _curves: tuple[tuple[CurveRow, ...] | None, frozenset[Port] | None, tuple[CurveRow, ...]] = (None, None, ())
    _kept: tuple[object, ...] = ()

    def rows(self, graph: Graph, selection: frozenset[str]) -> tuple[CurveRow, ...]:
        """The rows, made again only when something has changed."""
        asked = (self.only_selected, frozenset(self.folded), selection)
        of = (graph.animation, graph.nodes, asked)
        known = self._rows[0]
        if len(known) != 3 or known[0] is not of[0] or known[1] is not of[1] or known[2] != asked:
            self._rows = of, rows(graph, selection, self.only_selected, self.folded)
        return self._rows[1]

    def curves(self, all: tuple[CurveRow, ...]) -> tuple[CurveRow, ...]:
        """The rows whose curves are drawn; values of folded nodes are not."""
        known, shown, found = self._curves
        if known is not all or shown is not self.shown:
            found = tuple(row for row in all if row.port)
            if any(row.port in self.shown for row in found):
                found = tuple(row for row in found if row.port in self.shown)
            self._curves = all, self.shown, found
        return found

    def tidy(self, graph: Graph) -> None:
        """Forget what is not there any more."""
        if self._kept and self._kept[0] is graph.animation:
            return
        self._kept = (graph.animation,)
        animation = graph.animation
        self.spots = frozenset(
            spot
            for spot in self.spots
            if isinstance(keys := animation.get(spot[0]), Keys) and keys.key(spot[1]) is not None
        )
        self.shown = frozenset(port for port in self.shown if port in animation)
        self.hidden = {lane for lane in self.hidden if lane[0] in animation}

    def fit(self, what: Fit = "all") -> None:
        """Bring something into view."""
        self.wanted = what

    def choose(self, spots: frozenset[Spot], how: Literal["replace", "add", "toggle", "remove"] = "replace") -> None:
        """Choose keys: those alone, those too, the others of both, or no longer those."""
        match how:
            case "replace":
                self.spots = spots
            case "add":
                self.spots |= spots
            case "remove":
                self.spots -= spots
            case "toggle":
                self.spots = self.spots - spots if spots <= self.spots else self.spots | spots

    @property
    def single(self) -> tuple[Port, float] | None:
        """The chosen key, if it is one alone."""
        found = {(port, frame) for port, frame, _ in self.spots}
        return next(iter(found)) if len(found) == 1 else None

"""Everything that one editor window has. Only the window knows it whole; panels get the parts that they use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import field

from ..canvas.view import CanvasView
from ..code.state import CodeState
from ..curves.state import CurvesState
from ..theme.palette import Palette
from ..timeline.state import TimelineState
from ..toolkit.places import Rect
from ..toolkit.services import Services
from ..viewer.state import ViewerState

if TYPE_CHECKING:
    from ..shared.action import Scope


class Editor(Services):
    """What all panels share, and the state of each panel."""

    canvas: CanvasView = field(default_factory=CanvasView)
    viewer: ViewerState = field(default_factory=ViewerState)
    code: CodeState = field(default_factory=CodeState)
    curves: CurvesState = field(default_factory=CurvesState)
    timeline: TimelineState = field(default_factory=TimelineState)
    scope: Scope = "graph"
    """The panel whose shortcuts work: the last one under the mouse."""
    waiting_action: str = ""
    """An action whose keys were pressed in a text field: it runs when the field has given up the keyboard."""

    @property
    def places(self) -> dict[str, Rect]:
        """Where widgets were drawn last, by name."""
        return self.interface.places

    @property
    def palette(self) -> Palette:
        """The colors of the theme."""
        return self.interface.palette

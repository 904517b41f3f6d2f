"""Everything that one editor window has. Panels draw it, actions change it; nothing here knows how it looks."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol, TypeVar

from ...authoring.log import Log
from ...authoring.services.renders import Renders
from ...authoring.services.shader_files import ShaderFiles
from ...errors import HalationError
from ..canvas.view import CanvasView
from ..code.state import CodeState
from ..curves.state import CurvesState
from ..shared.dialogs import Dialogs
from ..theme.palette import PALETTES, Palette
from ..timeline.state import TimelineState
from ..viewer.state import ViewerState

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.services.exporting import Exports
    from ...authoring.services.preferences import Store
    from ...authoring.services.recovery import Recovery
    from ...authoring.session import Session
    from ...renderer.viewing.display import Display
    from ...renderer.viewing.probe import Probe
    from ...watch.watching import Watcher
    from ..shared.action import Actions, Scope
    from ..theme.fonts import Fonts

T = TypeVar("T")

Rectangle = tuple[float, float, float, float]
"""Left, top, right, bottom in pixels of the screen."""


class Clipboard(Protocol):
    """The clipboard of the system."""

    def get(self) -> str: ...

    def put(self, text: str) -> None: ...


@dataclass
class Editor:
    """One window: the document, its pictures, what the person likes, and what is going on."""

    session: Session
    preview: Preview
    store: Store
    actions: Actions
    exports: Exports
    recovery: Recovery
    watcher: Watcher
    clipboard: Clipboard
    display: Display
    probe: Probe
    fonts: Fonts | None = None
    renders: Renders = field(default_factory=Renders)
    shaders: ShaderFiles = field(default_factory=ShaderFiles)
    canvas: CanvasView = field(default_factory=CanvasView)
    viewer: ViewerState = field(default_factory=ViewerState)
    code: CodeState = field(default_factory=CodeState)
    curves: CurvesState = field(default_factory=CurvesState)
    timeline: TimelineState = field(default_factory=TimelineState)
    dialogs: Dialogs = field(default_factory=Dialogs)
    log: Log = field(default_factory=Log)
    faults: dict[str, str] = field(default_factory=dict[str, str])
    """Panels that failed, with the traceback: shown in Problems."""
    dragging: bool = False
    """True while a value is being dragged: pictures may be coarse until it is let go."""
    places: dict[str, Rectangle] = field(default_factory=dict[str, Rectangle])
    """Where things were drawn last, by name: for tests and hints."""
    lights: dict[str, int] = field(default_factory=dict[str, int])
    """The light that is selected of every value that lists some: the inspector shows it, the viewer marks it."""
    requests: set[str] = field(default_factory=set[str])
    """What the window shall do next: "reset layout", "screenshot", "show Renders" or another panel."""
    scope: Scope = "graph"
    """The panel that keys go to: the one that the mouse was over last."""
    closing: bool = False
    """True lets the window close."""

    def attempt(self, act: Callable[[], T], default: T | None = None) -> T | None:
        """Do something for a person: a mistake becomes a sentence in the log, a bug is reported, nothing is lost."""
        try:
            return act()
        except HalationError as error:
            self.log.add(str(error), "error")
        except Exception as error:
            self.log.add(
                f"this did not work because of a fault in Halation ({type(error).__name__}: {error}); "
                "the document is as it was before",
                "error",
                traceback.format_exc(),
            )
        return default

    def say(self, sentence: str) -> None:
        """Tell the person something."""
        self.log.add(sentence)

    @property
    def stage(self) -> Editor:
        """The same editor for what shows pictures and time: with the flipbook as its document while one is open."""
        book = self.viewer.flipbook
        return self if book is None else replace(self, session=book.session)

    @property
    def palette(self) -> Palette:
        """The colors of the present theme."""
        return PALETTES[self.store.now.theme]

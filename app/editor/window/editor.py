"""Everything that one editor window has. Only the window knows it whole; panels get the parts that they use."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ...authoring.log import Log
from ...authoring.services.coloring import Coloring
from ...authoring.services.exporting import Exports
from ...authoring.services.renders import Renders
from ...authoring.services.shader_files import ShaderFiles
from ...watch.watching import Watcher
from ..canvas.view import CanvasView
from ..code.state import CodeState
from ..curves.state import CurvesState
from ..shared.dialogs import Dialogs
from ..shared.stage import Stage
from ..shared.window_commands import WindowCommands
from ..theme.palette import Palette
from ..timeline.state import TimelineState
from ..toolkit.context import Interface
from ..toolkit.places import Rect
from ..viewer.state import ViewerState

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.services.preferences import Store
    from ...authoring.services.recovery import Recovery
    from ...authoring.session import Session
    from ...renderer.viewing.display import Display
    from ...renderer.viewing.probe import Probe
    from ..shared.action import Actions, Scope
    from ..shared.protocols import Clipboard


@dataclass
class Editor:
    """One window: the document, its pictures, the user's preferences, the state of each panel, and what goes on."""

    stage: Stage
    preview: Preview
    store: Store
    actions: Actions
    recovery: Recovery
    clipboard: Clipboard
    display: Display
    probe: Probe
    interface: Interface
    log: Log = field(default_factory=Log)
    exports: Exports = field(default_factory=Exports)
    watcher: Watcher = field(default_factory=Watcher)
    renders: Renders = field(default_factory=Renders)
    shaders: ShaderFiles = field(default_factory=ShaderFiles)
    coloring: Coloring = field(default_factory=Coloring)
    canvas: CanvasView = field(default_factory=CanvasView)
    viewer: ViewerState = field(default_factory=ViewerState)
    code: CodeState = field(default_factory=CodeState)
    curves: CurvesState = field(default_factory=CurvesState)
    timeline: TimelineState = field(default_factory=TimelineState)
    dialogs: Dialogs = field(default_factory=Dialogs)
    commands: WindowCommands = field(default_factory=WindowCommands)
    faults: dict[str, str] = field(default_factory=dict[str, str])
    """Panels that failed, with the traceback: shown in Problems."""
    lights: dict[str, int] = field(default_factory=dict[str, int])
    """The light that is selected, by the value that lists it: the inspector shows it, the viewer marks it."""
    scope: Scope = "graph"
    """The panel that keys go to: the one that the mouse was over last."""

    @property
    def session(self) -> Session:
        """The document."""
        return self.stage.document

    @property
    def places(self) -> dict[str, Rect]:
        """Where widgets were drawn last, by name."""
        return self.interface.places

    @property
    def palette(self) -> Palette:
        """The colors of the theme."""
        return self.interface.palette

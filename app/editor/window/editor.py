"""Everything that one editor window has. Only the window knows it whole; panels get the parts that they use."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ...authoring.background.render_overviews import RenderOverviews
from ...authoring.background.shader_files import ShaderFiles
from ...authoring.log import Log
from ...authoring.preview.color_fallback import ColorFallback
from ...authoring.render_queue.queue import RenderQueue
from ...watch.watching import FileWatcher
from ..canvas.view import CanvasView
from ..code.state import CodeState
from ..curves.state import CurvesState
from ..shared.dialogs import Dialogs
from ..shared.stage import DocumentStage
from ..shared.window_commands import WindowCommands
from ..theme.palette import Palette
from ..timeline.state import TimelineState
from ..toolkit.context import Interface
from ..toolkit.places import Rect
from ..viewer.state import ViewerState

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.preview import Preview
    from ...authoring.recovery.recovery import RecoveryFile
    from ...authoring.session import Session
    from ...renderer.viewing.display import Display
    from ...renderer.viewing.probe import PixelProbe
    from ..shared.action import Actions, Scope
    from ..shared.protocols import SystemText


@dataclass
class Editor:
    """One window: the document, its pictures, the user's preferences, the state of each panel, and what goes on."""

    stage: DocumentStage
    preview: Preview
    store: PreferenceStore
    actions: Actions
    recovery: RecoveryFile
    clipboard: SystemText
    display: Display
    probe: PixelProbe
    interface: Interface
    exports: RenderQueue
    watcher: FileWatcher
    renders: RenderOverviews
    coloring: ColorFallback
    log: Log = field(default_factory=Log)
    shaders: ShaderFiles = field(default_factory=ShaderFiles)
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

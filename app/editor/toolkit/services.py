"""What the panels of a window share."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct, field

from ...authoring.background.render_overviews import RenderOverviews
from ...authoring.background.shader_files import ShaderFiles
from ...authoring.library import PresetLibrary
from ...authoring.log import Log
from ...authoring.preview.color_fallback import ColorFallback
from ...authoring.render_queue.queue import RenderQueue
from ...watch.watching import FileWatcher
from ..shared.dialogs import Dialogs
from ..shared.stage import DocumentStage
from ..shared.window_commands import WindowCommands
from .context import Interface

if TYPE_CHECKING:
    from ...authoring.preferences import PreferenceStore
    from ...authoring.preview import Preview
    from ...authoring.preview.node_timer import NodeTimer
    from ...authoring.preview.pass_pictures import PassPictures
    from ...authoring.preview.value_strip import ValueStrip
    from ...authoring.recovery.recovery import RecoveryFile
    from ...authoring.session import Session
    from ...renderer.viewing.display import Display
    from ...renderer.viewing.probe import PixelProbe
    from ..shared.action import Actions
    from ..shared.protocols import SystemText


class Services(Struct):
    """The document, its pictures, the user's preferences, and what goes on in the background.

    Only the `compose` of each panel's context sees all of it, to pick what that panel uses.
    """

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
    passes: PassPictures
    strip: ValueStrip
    node_timer: NodeTimer
    log: Log = field(default_factory=Log)
    shaders: ShaderFiles = field(default_factory=ShaderFiles)
    library: PresetLibrary = field(default_factory=PresetLibrary)
    dialogs: Dialogs = field(default_factory=Dialogs)
    commands: WindowCommands = field(default_factory=WindowCommands)
    faults: dict[str, str] = field(default_factory=dict[str, str])
    """Panels that failed, with the traceback: shown in Problems."""
    items: dict[str, str] = field(default_factory=dict[str, str])
    """The name of the selected item of each value with named items: the inspector shows it, the viewer marks it."""

    @property
    def session(self) -> Session:
        """The document."""
        return self.stage.document

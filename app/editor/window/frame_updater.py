"""What happens in every frame of the window before anything is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from halation.nodes import plugins
from imgui_bundle import imgui

from ...compiler.library import reload_library
from ...graph import Port
from ...watch.code_files import code_files
from ...watch.reloading import NodeFiles, migrate_graph, shader_folder
from ...watch.sequence_files import list_sequence_files
from ...watch.watching import FileChange, find_group_files, find_pictures
from ..viewer.wanted import find_visible_region, list_wanted_ports

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .contexts import Contexts
    from .editor import Editor

FRAME_BUDGET = 0.012
"""Seconds of rendering per frame: the rest of a sixtieth is for drawing panels."""

PLAY_BUDGET = 0.030
"""The same while frames are played, which is what is looked at then."""


class FrameUpdater:
    """Lets files be watched, unsaved work be kept, and pictures be computed within the budget of one frame."""

    def __init__(self, editor: Editor, contexts: Contexts) -> None:
        self._editor, self._contexts = editor, contexts
        self._nodes = NodeFiles()
        self._watched: tuple[object, ...] = ()
        self._flushed = float("-inf")
        self._reported: set[str] = set()

    def update(self) -> None:
        """Do the work of one frame."""
        editor = self._editor
        editor.code.begin_frame()
        self._watch()
        for change in editor.watcher.poll():
            editor.log.attempt(lambda change=change: self._take_change(change))
        editor.recovery.note(editor.session.recoverable, editor.session.path, editor.session.dirty)
        if imgui.get_time() - self._flushed > 1.0:
            self._flushed = imgui.get_time()
            editor.store.flush()
            self._report_faults()
        self._contexts.flipbooks.follow()
        self._compute()

    def _report_faults(self) -> None:
        """Log once what services cannot do; Problems shows it for as long as it lasts."""
        editor = self._editor
        refused = {f"The plug-in {plugin} cannot be loaded: {plugin.fault}" for plugin in plugins() if plugin.fault}
        faults = {editor.recovery.fault, editor.watcher.fault, *editor.store.faults, *refused} - {""}
        for sentence in sorted(faults - self._reported):
            editor.log.add(sentence, "warning")
        self._reported = faults

    def _compute(self) -> None:
        """Compute what the viewer and the canvas show, for as long as the budget lasts."""
        editor, context = self._editor, self._contexts.viewer
        preview, preferences, session = editor.preview, editor.store.current, context.session
        preview.thumbnailing, preview.timed = preferences.thumbnails, preferences.timings
        preview.paused = editor.viewer.paused
        self._play(session)
        ports, scale = list_wanted_ports(context)
        preview.glimpse = find_visible_region(context)
        place = session.place
        flat = {name: Port("/".join((*place, port.node)), port.socket) for name, port in ports.items()}
        preview.want(session.root, flat, bindings=session.bindings, scale=scale, frame=session.frame)
        preview.work(PLAY_BUDGET if editor.timeline.playing else FRAME_BUDGET)

    def _play(self, session: Session) -> None:
        """Go on to the frame that is due."""
        timeline, preview = self._editor.timeline, self._editor.preview
        playback, time_now = timeline.playback, imgui.get_time()
        if playback.playing:
            playback.keep(timeline.course(session, preview.remembers), session.frame, time_now)
            if not preview.busy:
                playback.note(time_now)
            words = playback.words
            frame = playback.tick(time_now, preview.busy and not preview.paused, preview.under_way)
            timeline.report = words
            if frame is not None:
                session.seek(frame)
        preview.skims = playback.playing or timeline.scrubbing
        preview.ahead = playback.ahead(preview.seconds)

    def _watch(self) -> None:
        """Watch the files that the graph reads."""
        editor = self._editor
        session = editor.session
        reads = (id(session.root), session.path, tuple(session.bindings.items()))
        if reads == self._watched:
            return
        self._watched = reads
        editor.watcher.watch(
            session.path,
            find_group_files(session.root),
            list_sequence_files(find_pictures(session.root, session.bindings), sandbox=session.sandbox),
            [shader_folder()],
            [self._nodes.folder],
            code_files(session.root),
        )
        session.note_code_files()

    def _take_change(self, change: FileChange) -> None:
        """Read a file again after another program wrote it."""
        editor = self._editor
        match change.kind:
            case "graph":
                self._contexts.documents.load_changed_file(change.path)
            case "group":
                editor.session.reload_groups()
            case "picture":
                editor.preview.refresh()
                editor.session.look_again()
                editor.log.add(f"{change.path.name} changed on disk and was read again")
            case "code":
                self._contexts.code_files.reread(change.path)
            case "shader":
                editor.preview.reload(reload_library())
                editor.log.add(f"shader {change.path.name} was loaded again")
            case "node":
                if fault := self._nodes.reload():
                    editor.log.add(fault, "error")
                else:
                    editor.session.migrate(migrate_graph)
                    editor.log.add(f"node {change.path.name} was loaded again")

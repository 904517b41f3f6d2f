"""What happens every frame before anything is drawn."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from pathlib import Path

from halation.nodes import plugins

from ...compiler import installed
from ...graph import Port
from ...watch.code_files import code_files
from ...watch.reloading import NodeFiles, migrated, shader_folder
from ...watch.sequence_files import all_files
from ...watch.watching import Change, groups_of, pictures_of
from ..shared.dialogs import Question
from ..viewer.wanted import glimpse, wanted
from ..workflows.code_files import code_changed
from ..workflows.flipbook import follow_flipbook
from .editor import Editor

FRAME_BUDGET = 0.012
"""Seconds of rendering per frame: the rest of a sixtieth is for drawing panels."""

PLAY_BUDGET = 0.030
"""The same while frames are played, which is what is looked at then."""


@dataclass
class Heartbeat:
    """Lets pictures be computed, files be watched and work be kept."""

    nodes: NodeFiles = field(default_factory=NodeFiles)
    _watched: tuple[object, ...] = ()
    _flushed: float = 0.0
    _told: set[str] = field(default_factory=set[str])

    def beat(self, editor: Editor) -> None:
        """One frame."""
        editor.code.turn()
        self._watch(editor)
        for change in editor.watcher.poll():
            editor.attempt(lambda change=change: self._changed(editor, change))
        editor.recovery.note(editor.session.recoverable, editor.session.path, editor.session.dirty)
        if time.monotonic() - self._flushed > 1.0:
            self._flushed = time.monotonic()
            editor.store.flush()
            self._tell(editor)
        follow_flipbook(editor)
        self._compute(editor.stage)

    def _tell(self, editor: Editor) -> None:
        """What services cannot do is said once; Problems shows it for as long as it lasts."""
        refused = {f"The plug-in {plugin} cannot be loaded: {plugin.fault}" for plugin in plugins() if plugin.fault}
        now = {editor.recovery.fault, editor.watcher.fault, *editor.store.faults, *refused} - {""}
        for sentence in sorted(now - self._told):
            editor.log.add(sentence, "warning")
        self._told = now

    def _compute(self, editor: Editor) -> None:
        preview, likes = editor.preview, editor.store.now
        preview.thumbnailing, preview.timed = likes.thumbnails, likes.timings
        preview.paused = editor.viewer.paused
        self._play(editor)
        ports, scale = wanted(editor)
        preview.glimpse = glimpse(editor)
        place = editor.session.place
        flat = {name: Port("/".join((*place, port.node)), port.socket) for name, port in ports.items()}
        preview.want(
            editor.session.root, flat, bindings=editor.session.bindings, scale=scale, frame=editor.session.frame
        )
        preview.work(PLAY_BUDGET if editor.timeline.playback.playing else FRAME_BUDGET)

    def _play(self, editor: Editor) -> None:
        """Go on to the frame that is due."""
        timeline, preview, session = editor.timeline, editor.preview, editor.session
        playback, now = timeline.playback, time.monotonic()
        if playback.playing:
            playback.keep(timeline.course(session, preview.remembers), session.frame, now)
            if not preview.busy:
                playback.note(now)
            words = playback.words
            frame = playback.tick(now, preview.busy and not preview.paused, preview.under_way)
            timeline.report = words
            if frame is not None:
                session.seek(frame)
        preview.skims = playback.playing or timeline.scrubbing
        preview.ahead = playback.ahead(preview.seconds)

    def _watch(self, editor: Editor) -> None:
        """Watch the files that the graph reads."""
        session = editor.session
        now = (id(session.root), session.path, tuple(session.bindings.items()))
        if now == self._watched:
            return
        self._watched = now
        editor.watcher.watch(
            session.path,
            groups_of(session.root),
            all_files(pictures_of(session.root, session.bindings)),
            [shader_folder()],
            [self.nodes.folder],
            code_files(session.root),
        )
        session.note_code_files()

    def _changed(self, editor: Editor, change: Change) -> None:
        match change.kind:
            case "graph":
                _graph_changed(editor, change.path)
            case "group":
                editor.session.reload_groups()
            case "picture":
                editor.preview.refresh()
                editor.session.look_again()
                editor.say(f"{change.path.name} changed on disk and was read again")
            case "code":
                code_changed(editor, change.path)
            case "shader":
                installed.cache_clear()
                editor.preview.reload(installed())
                editor.say(f"shader {change.path.name} was loaded again")
            case "node":
                if fault := self.nodes.reload():
                    editor.log.add(fault, "error")
                else:
                    editor.session.migrate(migrated)
                    editor.say(f"node {change.path.name} was loaded again")


def _graph_changed(editor: Editor, path: Path) -> None:
    """Somebody else wrote the file that is open."""
    session = editor.session
    if not session.dirty:
        session.reload()
        editor.say(f"{path.name} changed on disk and was loaded again")
        return
    editor.dialogs.question = Question(
        "Changed on disk",
        f"{path.name} was changed by another program, and here are changes that are not saved.",
        (
            ("Load theirs", lambda: editor.attempt(session.reload)),
            ("Keep mine", lambda: editor.say("kept; saving will replace the other version")),
        ),
    )

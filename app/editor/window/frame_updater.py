"""What happens in every frame of the window before anything is drawn."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import catalogue, plugins
from imgui_bundle import imgui

from ...authoring.preview.preview import PATIENCE
from ...authoring.preview.request import PreviewRequest
from ...compiler.library import reload_library
from ...graph import Port
from ...language.translation import mark, translate
from ...watch.code_files import code_files
from ...watch.reloading import NodeFiles, migrate_graph, shader_folder
from ...watch.sequence_files import list_sequence_files
from ...watch.watching import FileChange, Kind, find_group_files, find_pictures
from ..problems.findings import service_faults
from ..viewer.wanted import A, find_visible_region, list_wanted_ports, list_whole_sides

if TYPE_CHECKING:
    from ...authoring.session import Session
    from .contexts import Contexts
    from .editor import Editor

_LONG = 0.3
"""Seconds of waiting for a file after which fewer frames are drawn; most files are read within that."""

FRAME_BUDGET = 0.012
"""Seconds of rendering per frame of the window: the rest of a sixtieth of a second is for drawing panels."""

PLAY_BUDGET = 0.030
"""Seconds of rendering per frame of the window during playback, when panels hardly change."""

STROKE_BUDGET = 0.5
"""Seconds that a frame of the window may wait for the picture of a stroke under the pointer: a reply within 0.1 s seems
immediate (Nielsen 1993). A frame without the picture would only show that the stroke is behind."""

_DELETED: Mapping[Kind, str] = MappingProxyType(
    {
        "graph": mark("saving writes it again"),
        "group": mark("the group stays as it was read"),
        "picture": mark("put it back, or choose another file"),
        "code": mark("the code stays as it was read; saving writes it again"),
    }
)
"""What follows for the user from a file that is gone, by what it holds."""

OVER_BUDGET = 2
"""Consecutive seconds over the budget before a warning: a single picture may exceed it for a moment."""


class FrameUpdater:
    """Watches files, keeps unsaved work, and computes pictures within the budget of one frame."""

    def __init__(self, editor: Editor, contexts: Contexts) -> None:
        self._editor, self._contexts = editor, contexts
        self._nodes = NodeFiles()
        self._unloaded_nodes = list(catalogue())
        self._watched: tuple[object, ...] = ()
        self._flushed = float("-inf")
        self._reported: set[str] = set()
        self._seconds_over_budget = 0
        self.is_working = False
        """True while there is more to compute."""
        self._ready_at = 0.0
        """When no picture waited for a file, last."""

    def update(self) -> None:
        """Do the work of one frame."""
        editor = self._editor
        editor.code.begin_frame()
        self._watch()
        for change in editor.watcher.poll():
            editor.log.attempt(lambda change=change: self._take_change(change))
        editor.recovery.claim(editor.session.path)
        editor.recovery.note(editor.session.code_files.recoverable_root, editor.session.path, editor.session.dirty)
        if imgui.get_time() - self._flushed > 1.0:
            self._flushed = imgui.get_time()
            editor.store.flush()
            self._report_faults()
        self._contexts.flipbooks.follow()
        self._compute()

    def _report_faults(self) -> None:
        """Log once what services cannot do; Problems shows it for as long as it lasts."""
        editor = self._editor
        refused = {
            translate("The plug-in {plugin} cannot be loaded: {fault}", plugin=plugin, fault=plugin.fault)
            for plugin in plugins()
            if plugin.fault
        }
        services = service_faults(self._contexts.problems)
        faults = {*services, *refused, self._find_memory_fault()} - {""}
        for sentence in sorted(faults - self._reported):
            editor.log.add(sentence, "warning")
        self._reported = faults

    def _find_memory_fault(self) -> str:
        """A sentence if pictures have taken more memory than they may for a while, else ""."""
        used, budget = self._editor.preview.memory
        self._seconds_over_budget = self._seconds_over_budget + 1 if used > budget else 0
        if self._seconds_over_budget < OVER_BUDGET:
            return ""
        return translate(
            "the pictures of this graph need more memory than the budget of {megabytes:.0f} MiB, so "
            "nothing is kept: raise the budget in the preferences, or choose a smaller proxy in the "
            "viewer",
            megabytes=budget / 2**20,
        )

    def _compute(self) -> None:
        """Compute what the viewer and the canvas show, within the budget."""
        editor, context = self._editor, self._contexts.viewer
        preview, preferences, session = editor.preview, editor.store.current, context.session
        preview.thumbnailing, preview.timed = preferences.thumbnails, preferences.timings
        preview.paused = editor.viewer.paused
        self._play(session)
        ports, scale = list_wanted_ports(context)
        preview.glimpse = find_visible_region(context)
        place = session.place
        flat = {name: Port("/".join((*place, port.node)), port.socket) for name, port in ports.items()}
        whole, frame = list_whole_sides(context), session.time.frame
        preview.want(session.root, flat, bindings=session.bindings, scale=scale, frame=frame, whole=whole)
        is_painting = editor.viewer.brush.stroke != ""
        preview.patience = math.inf if is_painting else PATIENCE
        seconds = PLAY_BUDGET if editor.timeline.playing else FRAME_BUDGET
        self.is_working = preview.work(seconds, STROKE_BUDGET if is_painting else 0.0)
        if not preview.is_decoding:
            self._ready_at = time.perf_counter()
        self.is_working = self._run_passes(flat, scale) or self.is_working
        self.is_working = self._work_on_page() or self.is_working
        if not self.is_working and not editor.interface.dragging and not editor.canvas.panning:
            self.is_working = self._load_nodes()

    @property
    def waits_long(self) -> bool:
        """True while a large file is decoded: frames would take time from that, and show nothing new."""
        return self.is_working and time.perf_counter() - self._ready_at > _LONG

    def _load_nodes(self) -> bool:
        """Load classes of nodes for some milliseconds, so that the search opens at once; True while there are more.

        Those of the graph are there already; to load all of them first would keep the window closed for long.
        """
        end = time.perf_counter() + FRAME_BUDGET / 2
        while self._unloaded_nodes and time.perf_counter() < end:
            catalogue()[self._unloaded_nodes.pop()]
        return bool(self._unloaded_nodes)

    def _run_passes(self, ports: Mapping[str, Port], scale: float) -> bool:
        """Run the next pass for the panel of passes, if somebody looks at it; True while there are more."""
        editor, session = self._editor, self._contexts.viewer.session
        passes, port = editor.passes, ports.get(A)
        if port is None:
            passes.clear()
            return False
        if not passes.is_shown or editor.timeline.playing or editor.preview.busy:
            return False
        passes.is_shown = False
        passes.want(PreviewRequest(session.root, {A: port}, dict(session.bindings), scale, session.time.frame, None))
        return passes.work()

    def _work_on_page(self) -> bool:
        """Draw the next part of the strip on the page of a node, or measure the node; True while there is more."""
        strip, timer = self._editor.strip, self._editor.node_timer
        if not timer.is_shown:  # the page is closed: nobody waits for the time, and it takes memory
            timer.stop()
        if not strip.is_shown or self._editor.preview.busy:
            return False
        strip.is_shown = timer.is_shown = False
        return strip.work() or timer.work()

    def _play(self, session: Session) -> None:
        """Go to the frame that playback shows now."""
        timeline, preview = self._editor.timeline, self._editor.preview
        playback, time_now = timeline.playback, imgui.get_time()
        if playback.playing:
            playback.keep(timeline.course(session, preview.remembers), session.time.frame, time_now)
            if not preview.busy:
                playback.note(time_now)
            words = playback.words
            frame = playback.tick(time_now, preview.busy and not preview.paused, preview.under_way)
            timeline.report = words
            if frame is not None:
                session.time.seek(frame)
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
        session.code_files.read_missing()

    def _take_change(self, change: FileChange) -> None:
        """Read a file again after another program wrote it."""
        editor = self._editor
        if not change.exists and (consequence := translate(_DELETED.get(change.kind, ""))):
            editor.log.add(
                translate("{name} was deleted or moved: {consequence}", name=change.path.name, consequence=consequence),
                "warning",
            )
            if change.kind == "picture":
                editor.preview.refresh()
                editor.session.time.remeasure()
            return
        match change.kind:
            case "graph":
                self._contexts.documents.load_changed_file(change.path)
            case "group":
                editor.session.files.reload_groups()
            case "picture":
                editor.preview.refresh()
                editor.session.time.remeasure()
                editor.log.add(translate("{name} changed on disk and was read again", name=change.path.name))
            case "code":
                self._contexts.code_files.reread(change.path)
            case "shader":
                editor.preview.reload(reload_library())
                editor.log.add(translate("shader {name} was loaded again", name=change.path.name))
            case "node":
                if fault := self._nodes.reload():
                    editor.log.add(fault, "error")
                else:
                    editor.session.migrate(migrate_graph)
                    editor.log.add(translate("node {name} was loaded again", name=change.path.name))

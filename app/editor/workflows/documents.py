"""Opening, saving and closing documents, with the questions that protect unsaved work."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from ...authoring.document_pictures import DocumentPictures
from ...errors import HalationError
from ...language.translation import translate, translate_plural
from ...media.pictures.file_endings import is_picture
from ...renderer.provenance.recipe import has_recipe
from ...resources.sandbox import Sandbox
from ..shared.action import Action
from ..shared.dialogs import Browse, Question
from ..shared.window_commands import PanelTitle

if TYPE_CHECKING:
    from ...authoring.log import Log
    from ...authoring.preferences import PreferenceStore
    from ...authoring.recovery.recovery import RecoveredWork, RecoveryFile
    from ...authoring.render_queue.queue import RenderQueue
    from ...authoring.session import Session
    from ...watch.watching import FileWatcher
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView, SnapshotSource
    from ..shared.window_commands import WindowCommands
    from ..toolkit.services import Services
    from .code_files import CodeFileWorkflow


def has_graph(path: Path, sandbox: Sandbox) -> bool:
    """True for a picture that Halation rendered, which holds the graph that made it."""
    try:
        return has_recipe(path, sandbox=sandbox)
    except HalationError:
        return False


def _do_nothing() -> None:
    """An answer that changes nothing."""


class LeavingLabels(Struct, frozen=True):
    """What the answers are called when unsaved work is about to be left: with saving it, and without."""

    saving: str
    losing: str


def _label_opening() -> LeavingLabels:
    return LeavingLabels(translate("Save and open"), translate("Open without saving"))


class DocumentWorkflow(Struct, frozen=True):
    """The actions of the File menu. Each one that would lose work asks first."""

    session: Session
    store: PreferenceStore
    watcher: FileWatcher
    recovery: RecoveryFile
    exports: RenderQueue
    canvas: ElementView
    dialogs: Dialogs
    log: Log
    commands: WindowCommands
    code_files: CodeFileWorkflow
    viewer: SnapshotSource
    pictures: DocumentPictures

    @classmethod
    def compose(
        cls, services: Services, canvas: ElementView, code_files: CodeFileWorkflow, viewer: SnapshotSource
    ) -> DocumentWorkflow:
        """Pick what the File menu uses."""
        return cls(
            services.session,
            services.store,
            services.watcher,
            services.recovery,
            services.exports,
            canvas,
            services.dialogs,
            services.log,
            services.commands,
            code_files,
            viewer,
            DocumentPictures(services.store.file.parent / "recent"),
        )

    # --- opening -----------------------------------------------------------------------------------------------------

    def ask_for_new(self) -> None:
        """Start an empty graph, after asking about unsaved work."""
        self._unless_unsaved(
            self.start_new,
            LeavingLabels(translate("Save and start a new graph"), translate("Start a new graph without saving")),
        )

    def start_new(self) -> None:
        """Start an empty graph."""
        self.session.files.new()
        self._show_document()

    def ask_for_graph(self) -> None:
        """Ask for a graph or a picture, and open it."""
        self.dialogs.browse = Browse(translate("Open a graph or a picture"), "graph", self.open_file, has_pictures=True)

    def ask_for_render(self) -> None:
        """Ask for a render, a picture or a sequence, and start a graph that reads it."""
        self.dialogs.browse = Browse(translate("Open a render or a picture"), "image", self.open_file)

    def open_file(self, path: Path) -> None:
        """Open a graph, or a picture; of one that Halation rendered the user says whether its graph is meant."""
        if not is_picture(path):
            self.open_graph(path)
        elif has_graph(path, self.session.sandbox):
            self.ask_graph_or_picture(path, lambda: self.open_picture(path))
        else:
            self.open_picture(path)

    def open_picture(self, path: Path, then: Callable[[], object] = _do_nothing) -> None:
        """Open a picture in a new document that reads it, after asking about unsaved work."""

        def open_reader() -> None:
            self.session.files.open_pictures([path])
            self._show_document()
            then()

        self._unless_unsaved(lambda: self.log.attempt(open_reader), _label_opening())

    def ask_graph_or_picture(self, path: Path, read: Callable[[], object]) -> None:
        """Ask what a picture of ours is wanted for: its graph, or its pixels."""
        self.dialogs.question = Question(
            translate("Rendered by Halation"),
            translate("{name} holds the graph that made it.", name=path.name),
            (
                (translate("Open its graph"), lambda: self.open_graph_of_picture(path)),
                (translate("Read it as a picture"), read),
            ),
        )

    def open_graph(self, path: Path) -> None:
        """Open a file, after asking about unsaved work."""

        def open_file() -> None:
            self.session.files.open(path)
            self.store.note_opened(path)
            self._show_document()

        self._unless_unsaved(lambda: self.log.attempt(open_file), _label_opening())

    def open_preset(self, path: Path, then: Callable[[], object] = _do_nothing) -> None:
        """Open a preset as a new document, after asking about unsaved work."""

        def open_copy() -> None:
            self.session.files.open_copy(path)
            self._show_document()
            then()

        self._unless_unsaved(
            lambda: self.log.attempt(open_copy),
            LeavingLabels(translate("Save and open the preset"), translate("Open the preset without saving")),
        )

    def open_graph_of_picture(self, path: Path) -> None:
        """Open the graph that rendered a picture as a new document, after asking about unsaved work."""

        def open_recipe() -> None:
            self.session.files.open_graph_of_picture(path)
            self._show_document()
            self.log.add(translate("the graph of {name}, as a new document", name=path.name))

        self._unless_unsaved(
            lambda: self.log.attempt(open_recipe),
            LeavingLabels(translate("Save and open the graph"), translate("Open the graph without saving")),
        )

    def recover(self, recovered: RecoveredWork) -> None:
        """Open work that was not saved, after asking about other unsaved work."""

        def restore() -> None:
            self.session.files.open_recovered(recovered)
            self.recovery.adopt(recovered, self.session.sandbox)
            self._show_document()

        labels = LeavingLabels(translate("Save and recover"), translate("Recover without saving"))
        self._unless_unsaved(lambda: self.log.attempt(restore), labels)

    # --- saving ------------------------------------------------------------------------------------------------------

    def save(self, then: Callable[[], object] = _do_nothing) -> None:
        """Save to the document's file, or ask for one. Ask first if another program changed the file."""
        path = self.session.path
        if path is None:
            self.save_as(then)
            return

        def write() -> None:
            self.code_files.save_drafts()
            self.session.files.save()
            self._keep_picture(path)
            self.watcher.expect(path)
            self.log.add(translate("saved {name}", name=path.name))
            then()

        if not self.watcher.differs(path):
            write()
            return
        self.dialogs.question = Question(
            translate("Changed on disk"),
            translate("{name} was changed by another program since you opened it.", name=path.name),
            ((translate("Replace it"), lambda: self.log.attempt(write)), (translate("Cancel"), _do_nothing)),
        )

    def save_as(self, then: Callable[[], object] = _do_nothing) -> None:
        """Ask for a file, and save to it."""

        def save(path: Path) -> None:
            target = path if path.suffix else path.with_suffix(".json")

            def write() -> None:
                self.code_files.save_drafts()
                self.session.files.save_as(target)
                self.watcher.expect(target)
                self.store.note_opened(target)
                self._keep_picture(target)
                self.log.add(translate("saved {name}", name=target.name))
                then()

            self.log.attempt(write)

        name = f"{self.session.name}.json"
        self.dialogs.browse = Browse(translate("Save the graph as"), "graph", save, saving=True, name=name)

    def revert(self) -> None:
        """Go back to the saved file, after asking."""
        self.dialogs.question = Question(
            translate("Revert"),
            translate("Go back to the last saved version? This can be undone."),
            (
                (translate("Revert"), lambda: self.log.attempt(self.session.files.revert)),
                (translate("Cancel"), _do_nothing),
            ),
        )

    def load_changed_file(self, path: Path) -> None:
        """Load the document's file again after another program wrote it; ask first if there is unsaved work."""
        if not self.session.dirty:
            self.session.files.reload()
            self.log.add(translate("{name} changed on disk and was loaded again", name=path.name))
            return
        self.dialogs.question = Question(
            translate("Changed on disk"),
            translate("{name} was changed by another program, and you have unsaved changes.", name=path.name),
            (
                (translate("Load theirs"), lambda: self.log.attempt(self.session.files.reload)),
                (
                    translate("Keep mine"),
                    lambda: self.log.add(translate("your changes are kept; saving will replace the file on disk")),
                ),
            ),
        )

    # --- closing -----------------------------------------------------------------------------------------------------

    def quit(self) -> None:
        """Close the window, after asking about renders that run and about unsaved work."""
        self._unless_rendering(
            lambda: self._unless_unsaved(
                self.commands.close, LeavingLabels(translate("Save and quit"), translate("Quit without saving"))
            )
        )

    def ask_to_close(self) -> bool:
        """True if the window may close now; else a question is open."""
        if not self.commands.closing:
            self.quit()
        return self.commands.closing

    def _unless_unsaved(self, then: Callable[[], object], labels: LeavingLabels) -> None:
        """Ask before unsaved work is left behind."""
        if not self.session.dirty:
            then()
            return
        self.dialogs.question = Question(
            translate("Unsaved changes"),
            translate("'{name}' has unsaved changes.", name=self.session.name),
            (
                (labels.saving, lambda: self.save(then)),
                (labels.losing, then),
                (translate("Cancel"), _do_nothing),
            ),
        )

    def _unless_rendering(self, then: Callable[[], object]) -> None:
        """Ask before renders to files are stopped."""
        count = len(self.exports.unfinished)
        if not count:
            then()
            return
        self.dialogs.question = Question(
            translate("Renders are not finished"),
            translate_plural(
                "A render is not finished. Finished frames are kept, and Resume continues from there.",
                "{count} renders are not finished. Finished frames are kept, and Resume continues from there.",
                count,
            ),
            ((translate("Stop rendering and quit"), then), (translate("Cancel"), _do_nothing)),
        )

    def open_match(self) -> None:
        """Open the window that matches a reference."""
        self.dialogs.matches = True

    def _keep_picture(self, path: Path) -> None:
        """Keep what the viewer shows as the picture of the document, for the start screen."""
        self.viewer.snapshot = lambda pixels: self.pictures.save(path, pixels)
        self.pictures.tidy((path, *(recent.path for recent in self.store.current.recent)))

    def _show_document(self) -> None:
        self.viewer.snapshot = None
        self.canvas.fit()
        self.dialogs.open.discard("start")


DOCUMENTS: tuple[Action[DocumentWorkflow], ...] = (
    Action("file.new", "New", DocumentWorkflow.ask_for_new, "File", "Ctrl+N"),
    Action("file.open", "Open...", DocumentWorkflow.ask_for_graph, "File", "Ctrl+O"),
    Action("file.open_render", "Open Render...", DocumentWorkflow.ask_for_render, "File", "Ctrl+Shift+O"),
    Action("file.start", "Presets and Recent Files...", lambda files: files.dialogs.open.add("start"), "File"),
    Action("file.save", "Save", DocumentWorkflow.save, "File", "Ctrl+S", separated=True),
    Action("file.save_as", "Save As...", DocumentWorkflow.save_as, "File", "Ctrl+Shift+S"),
    Action(
        "file.save_preset",
        "Save as Preset...",
        lambda files: files.dialogs.open.add("preset"),
        "File",
        contexts=frozenset({"node"}),
        doc="Save the selection, or the whole graph, under a name in the library: Tab, the start screen and the "
        "command line find it.",
    ),
    Action(
        "file.revert",
        "Revert",
        DocumentWorkflow.revert,
        "File",
        enabled=lambda files: files.session.path is not None and files.session.dirty,
    ),
    Action(
        "file.render",
        "Render to Files...",
        lambda files: files.commands.show_panel(PanelTitle.RENDERS),
        "File",
        "F12",
        separated=True,
    ),
    Action(
        "file.export",
        "Export...",
        lambda files: files.dialogs.open.add("export"),
        "File",
        doc="Write the graph for programs that know nothing of Halation: a web page, passes of GLSL, an ISF shader, or "
        "a table of colors.",
    ),
    Action(
        "file.match",
        "Match a Reference...",
        DocumentWorkflow.open_match,
        "File",
        contexts=frozenset({"node"}),
        doc="Find values that make the picture like another one: the same frame graded elsewhere, or a look.",
    ),
    Action("file.quit", "Quit", DocumentWorkflow.quit, "File", "Ctrl+Q", separated=True),
)

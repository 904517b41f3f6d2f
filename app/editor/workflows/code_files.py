"""Files with the code of nodes: written, moved into a file, read again after another program changed them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from msgspec import Struct

from ...authoring.commands import EmbedCode
from ...language.translation import translate
from ..shared.action import Action
from ..shared.dialogs import Browse, Question
from ..shared.window_commands import PanelTitle

if TYPE_CHECKING:
    from ...authoring.log import Log
    from ...authoring.session import Session
    from ...custom_nodes import Code
    from ...watch.watching import FileWatcher
    from ..shared.dialogs import Dialogs
    from ..shared.window_commands import WindowCommands
    from ..toolkit.services import Services


class CodeEditor(Protocol):
    """The Code panel, as far as files of code need it."""

    focus: bool
    """True asks it to take the keyboard."""

    def flush(self) -> object:
        """Take over the last typed text."""
        ...


class CodeFileWorkflow(Struct, frozen=True):
    """Reads and writes files with the code of nodes, and asks where both sides have changed."""

    session: Session
    watcher: FileWatcher
    dialogs: Dialogs
    log: Log
    editor: CodeEditor
    commands: WindowCommands

    @classmethod
    def compose(cls, services: Services, editor: CodeEditor) -> CodeFileWorkflow:
        """Pick what files of code use."""
        return cls(services.session, services.watcher, services.dialogs, services.log, editor, services.commands)

    @property
    def active_code(self) -> Code | None:
        """The code of the active node."""
        return self.session.code_files.find_code(self.session.active)

    @property
    def active_has_file(self) -> bool:
        """True if the code of the active node lies in a file."""
        code = self.active_code
        return code is not None and bool(code.file)

    def show(self) -> None:
        """Open the Code panel for the active node, ready for typing."""
        self.commands.show_panel(PanelTitle.CODE)
        self.editor.focus = True

    def save(self, id: str) -> None:
        """Write the code of a node to its file. Raises OutputError."""
        path = self.session.code_files.save(id)
        self.watcher.expect(path)
        self.log.add(translate("saved {name}", name=path.name))

    def save_drafts(self) -> None:
        """Write all code that differs from its file, as when its graph is saved. Raises OutputError."""
        self.editor.flush()
        for path in self.session.code_files.save_drafts():
            self.watcher.expect(path)
            self.log.add(translate("saved {name}", name=path.name))

    def export(self, id: str) -> None:
        """Ask for a file, write the code of a node to it, and let the node read it from there."""
        code = self.session.code_files.find_code(id)
        ending = ".fs" if code and code.language == "isf" else ".glsl"

        def save(path: Path) -> None:
            target = path if path.suffix else path.with_suffix(ending)

            def export() -> None:
                self.session.code_files.export(id, target)
                self.watcher.expect(target)

            self.log.attempt(export)

        self.dialogs.browse = Browse(
            translate("Move the code to a file"), "code", save, saving=True, name=f"{id}{ending}"
        )

    def reread(self, path: Path) -> None:
        """Read a file of code again after another program wrote it; ask first if its draft differs."""

        def load() -> None:
            self.session.code_files.reread(path)
            self.log.add(translate("{name} changed on disk and was loaded again", name=path.name))

        def keep() -> None:
            self.session.code_files.keep_draft(path)
            self.log.add(translate("your changes are kept; saving will replace the file on disk"))

        self.editor.flush()
        if not self.session.code_files.differs_from_disk(path):
            load()
            return
        self.dialogs.question = Question(
            translate("Changed on disk"),
            translate("{name} was changed by another program, and you have unsaved changes.", name=path.name),
            ((translate("Load theirs"), lambda: self.log.attempt(load)), (translate("Keep mine"), keep)),
        )


CODE: tuple[Action[CodeFileWorkflow], ...] = (
    Action(
        "code.edit",
        "Edit Code",
        CodeFileWorkflow.show,
        "Graph/Code",
        "Enter",
        "graph",
        lambda files: files.active_code is not None,
        contexts=frozenset({"code"}),
        doc="Show and edit the code of the node.",
        separated=True,
    ),
    Action(
        "code.save",
        "Save Code to Its File",
        lambda files: files.save(files.session.active),
        "Graph/Code",
        enabled=lambda files: files.active_has_file,
        contexts=frozenset({"code"}),
    ),
    Action(
        "code.export",
        "Move Code to a File...",
        lambda files: files.export(files.session.active),
        "Graph/Code",
        enabled=lambda files: files.active_code is not None,
        contexts=frozenset({"code"}),
        doc="Write the code to its own file, for use in other graphs. The node reads it from there from now on.",
    ),
    Action(
        "code.inline",
        "Move Code into the Graph",
        lambda files: files.session.apply(EmbedCode(files.session.active)),
        "Graph/Code",
        enabled=lambda files: files.active_has_file,
        contexts=frozenset({"code"}),
        doc="Keep the code in this graph; the file stays as it is.",
    ),
)

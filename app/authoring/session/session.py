"""A session: the document that the user works on, and the one way to change it.

`apply(command)` changes the document and adds a step to the history. Everything else is either a question, which
`OpenDocument` answers, or no change of the document: where the user is, what is selected, what the viewer shows, which
frame is current, which file the document belongs to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from halation.nodes import Node

from ...document import load, loads, save
from ...errors import GraphError, UsageError
from ...graph import INPUTS, Graph, Output, Port
from ...graph.keys import round_keys
from ...renderer.provenance.file_finder import load_graph_of_picture
from ...resources.atomic_write import write_text_atomically
from ...resources.sandbox import Sandbox
from ..commands.coding import LinkCodeFile
from ..commands.command import EditCommand, Edited
from ..commands.grouping import LinkGroup
from ..edits import coding, elements, folding, layout, paths, routes
from ..edits.element_id import NO_ELEMENT, ElementId
from ..edits.folding import GroupPath
from ..edits.ports import is_viewable, output_ports
from ..edits.selection import SelectMode, combine_selection
from ..state.code_files import CodeFiles
from ..state.history import History, HistoryStep, Snapshot
from ..state.open_document import MAX_FRAME, OpenDocument, Side

if TYPE_CHECKING:
    from ..recovery import RecoveredWork

T = TypeVar("T")


class Session(OpenDocument):
    """A document that is open in the editor; a new one at first.

    Whatever makes no sense raises HalationError with one sentence and changes nothing.
    """

    def __init__(self, types: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> None:
        super().__init__(types, sandbox=sandbox)
        self.revision = 0
        """Greater after every change of the document, the selection or the view."""
        self.code_files = CodeFiles(sandbox=self.sandbox)
        self.new()

    # --- changes of the document -------------------------------------------------------------------------------------

    def apply(self, command: EditCommand[T]) -> T:
        """Do what a command says, as one step of the history; gives what the command promises, such as a new id."""
        edited = command.apply(self)
        if edited.renamed is not None:
            self._follow_rename(*edited.renamed)
        if edited.root is not None:
            if edited.root != self.root:
                after = Snapshot(edited.root, self.place, self.selection, self.active)
                self._add_step(edited.label, after, edited.merge)
        elif edited.graph is not None:
            self._apply_graph(edited, edited.graph)
        if edited.view is not None:
            self.view(edited.view)
        return edited.outcome

    def undo(self) -> None:
        """Take the last step back."""
        self.go_to(self.history.position - 1)

    def redo(self) -> None:
        """Do again what was undone last."""
        self.go_to(self.history.position + 1)

    def go_to(self, position: int) -> None:
        """Take steps back or do them again until `position` of them are in force."""
        self.seal()
        snapshot = self.history.go_to(position)
        if snapshot is not None:
            self._move_to(snapshot)

    def seal(self) -> None:
        """End merging: the next edit is a step of its own."""
        self.history.seal()

    def abandon(self, merge: str) -> None:
        """Take an unfinished step back as if it had never been, as when a drag is cancelled."""
        before = self.history.abandon(merge)
        if before is not None:
            self._move_to(before)

    # --- where the user is, and what is seen -------------------------------------------------------------------------

    def select(self, elements: ElementId | Iterable[ElementId], mode: SelectMode = "replace") -> None:
        """Select elements, or change what is selected by them; unknown ones are left out."""
        self.seal()
        picked = [elements] if isinstance(elements, ElementId) else list(elements)
        self._select(*combine_selection(self.selection, self.active, picked, mode))

    def enter(self, id: str) -> None:
        """Show what is in a group."""
        folding.find_group(self.graph, id)
        self.go((*self.place, id))

    def leave(self, levels: int = 1) -> None:
        """Show the graph that the group is in, with the group selected."""
        self.go(self.place[: max(len(self.place) - levels, 0)])

    def go(self, place: GroupPath) -> None:
        """Show the graph at `place`. Raises GraphError if there is none."""
        folding.body_at(self.root, place)
        if place == self.place:
            return
        self.seal()
        group = ElementId(self.place[len(place)] if self.place[: len(place)] == place else "")
        self._move_to(Snapshot(self.root, place, frozenset({group} if group else ()), group))

    def seek(self, frame: float) -> None:
        """Make a frame the current one; it may lie outside of the range."""
        self._frame = min(max(round_keys(frame), -MAX_FRAME), MAX_FRAME)

    def view(self, port: Port, side: Side = "A") -> None:
        """Show an output of a node, or an end of the graph, on one side of the viewer."""
        if not is_viewable(self.graph, port):
            raise GraphError(f"there is no '{port}' to show")
        self._views[self.place, side] = (port,)
        self.revision += 1

    def view_element(self, element: ElementId, side: Side = "A") -> None:
        """Show a node's first output, or the one after that which is shown; an input or output of the graph itself."""
        if end := element.port:
            self.view(end, side)
            return
        ports = output_ports(self.graph, element)
        if not ports:
            raise GraphError(f"node '{element}' has no output to show")
        viewed = self.find_viewed_port(side) if (self.place, side) in self._views else None
        self.view(ports[(ports.index(viewed) + 1) % len(ports)] if viewed in ports else ports[0], side)

    def view_nothing(self, side: Side = "B") -> None:
        """Let a side show what it shows by default: nothing on B."""
        self._views.pop((self.place, side), None)
        self.revision += 1

    def recall_viewer(self, number: int, side: Side = "A") -> None:
        """Show the port that a number key recalls."""
        if number not in self.viewers:
            raise GraphError(f"nothing is assigned to viewer {number}: select a node and assign it first")
        self.view(self.viewers[number], side)

    def bind(self, name: str, path: str | None) -> None:
        """Bind an input of the document to a file (`path` or `path:layer`), or to none; this is not saved."""
        if name not in self.root.inputs:
            raise GraphError(f"the graph has no input '{name}' to bind a file to")
        self._bound.pop(name, None)
        if path:
            self._bound[name] = path
        self.revision += 1

    # --- the document as a file --------------------------------------------------------------------------------------

    def new(self) -> None:
        """Begin an empty document: one output, and nothing to show yet."""
        root = layout.pin_places(Graph(outputs={"image": Output()}))
        self._restart(root, None, root)

    def open(self, path: str | Path) -> None:
        """Open a graph file. Raises DocumentError; then everything is as before."""
        root = load(path, self.types, sandbox=self.sandbox)
        self._restart(root, Path(path), root)

    def open_copy(self, path: str | Path) -> None:
        """Open a graph file as a new document, as presets are: saving asks for a name. Raises DocumentError."""
        root = load(path, self.types, sandbox=self.sandbox)
        self._restart(root, None, root)

    def open_made(self, path: str | Path) -> None:
        """Open the graph that made a picture, as a new document that is called like it. Raises HalationError."""
        root = load_graph_of_picture(Path(path), self.types, sandbox=self.sandbox)
        self._restart(root, None, root)
        self._title = Path(path).stem

    def open_text(self, text: str) -> None:
        """Open the text of a graph file as a document without a file."""
        self._restart(loads(text, "text", catalogue=self.types, sandbox=self.sandbox), None, None)

    def restore(self, recovered: RecoveredWork) -> None:
        """Open work that was recovered; it has the file that it was to be saved as, but is not saved."""
        self._restart(recovered.load(self.sandbox), recovered.path, None)

    def save(self) -> None:
        """Save to the file that was opened. Raises UsageError if there is none."""
        if self.path is None:
            raise UsageError("this document has no file yet: choose one with Save As")
        self.save_as(self.path)

    def save_as(self, path: str | Path) -> None:
        """Save to a file; relative paths are rewritten so that they lead to the same files. Raises OutputError."""
        target = Path(path)
        paths.check_target(self.root, target)
        self.seal()
        folder = str(target.parent)
        root = paths.rebase_paths(self.root, folder)
        save(root, target, sandbox=self.sandbox)
        if root is not self.root:
            self.migrate(lambda graph: paths.rebase_paths(graph, folder))
        self.path, self._saved = target, self.root
        self.revision += 1

    def revert(self) -> None:
        """Go back to what was saved; this can be undone."""
        self._read_file_again("Revert")

    def reload(self) -> None:
        """Read the file again after another program changed it; this can be undone."""
        self._read_file_again("Reload")

    def reload_groups(self) -> None:
        """Read the files of all groups again; this is no step. Raises DocumentError, and then nothing changes."""
        bodies: dict[Path, Graph] = {}

        def read_body(path: Path) -> Graph:
            if path not in bodies:
                bodies[path] = load(path, self.types, sandbox=self.sandbox)
            return bodies[path]

        self.migrate(lambda graph: folding.reread_groups(graph, read_body))

    def save_group(self, id: str, path: str | Path, link: bool = False) -> None:
        """Save what is in a group as a graph file; with `link`, the group comes from that file from now on."""
        target = Path(path)
        body = paths.rebase_paths(folding.find_group(self.graph, id).body(), str(target.parent))
        paths.check_target(body, target)
        if self.path and self.path.resolve() == target.resolve():
            raise UsageError(f"{target}: this is the file of the document itself: choose another name")
        save(body, target, sandbox=self.sandbox)
        if link:
            self.apply(LinkGroup(id, target, body))

    def migrate(self, change: Callable[[Graph], Graph]) -> None:
        """Change the document, its whole history and what was saved, keeping what they mean; this is no step."""
        changed: dict[int, Graph] = {}

        def change_once(graph: Graph) -> Graph:
            if id(graph) not in changed:
                changed[id(graph)] = change(graph)
            return changed[id(graph)]

        root = change_once(self.root)
        saved = None if self._saved is None else change_once(self._saved)
        self.history.map_documents(change_once)
        self._saved = saved
        self._show_document(root)

    def look_again(self) -> None:
        """Find the frame range anew: files have changed."""
        self._memo.forget("frames")

    # --- files of code -----------------------------------------------------------------------------------------------

    @property
    def drafts(self) -> Mapping[Path, str]:
        """Code that differs from the file that it belongs to, by file."""
        return self.code_files.drafts(self.root)

    @property
    def recoverable(self) -> Graph:
        """The document with drafts in it: nothing else would bring them back."""
        root, drafts, sandbox = self.root, self.drafts, self.sandbox
        make = (lambda: coding.embed_drafts(root, drafts, sandbox)) if drafts else (lambda: root)
        return self._memo.get("recoverable", (root, drafts), make)

    def export_code(self, id: str, path: str | Path) -> None:
        """Write the code of a node to a file, from which it comes from then on. Raises OutputError."""
        command = LinkCodeFile(id, path)
        command.apply(self)  # nothing is written where the command makes no sense
        code = self.code(id)
        assert code is not None
        write_text_atomically(Path(path), code.text, sandbox=self.sandbox)
        self.code_files.note(paths.resolve_path(paths.relative(path, self.graph.folder), self.graph.folder), code.text)
        self.apply(command)

    def save_code(self, id: str) -> Path:
        """Write the code of a node to its file; returns that. Raises OutputError."""
        path = paths.resolve_path(self.code_in_file(id).file, self.graph.folder)
        return self._write_code(path, coding.file_texts(self.root)[path])

    def save_drafts(self) -> tuple[Path, ...]:
        """Write all code that differs from its file; returns the files. Raises OutputError."""
        return tuple(self._write_code(path, text) for path, text in self.drafts.items())

    def reread_code(self, path: Path) -> None:
        """Take over what another program wrote to a file of code, drafts of it included; this is no step."""
        self.code_files.forget(path)
        self.migrate(lambda graph: coding.reread_file_code(graph, path, sandbox=self.sandbox))
        self.note_code_files()

    def note_code_files(self) -> None:
        """Read the files of code that were not read yet."""
        self.code_files.read_missing(self.root)

    def differs_from_disk(self, path: Path) -> bool:
        """True if there is a draft of a file, and the file holds something else now."""
        drafts = self.drafts
        return path in drafts and self.code_files.differs(path, drafts[path])

    def keep_draft(self, path: Path) -> None:
        """Keep the code as it is here though another program changed its file: it is a draft now."""
        self.code_files.forget(path)
        self.note_code_files()

    # --- inside ------------------------------------------------------------------------------------------------------

    def _apply_graph(self, edited: Edited[T], graph: Graph) -> None:
        """Put `graph` where `self.graph` is, as one step; without a difference, only select."""
        if graph == self.graph:
            if edited.select is not None:
                self._select(edited.select, self.active)
            return
        graph = layout.pin_places(routes.tidy_routes(graph), self.graph)
        root = folding.put_body(self.root, self.place, graph, edited.moves)
        folding.check_depth(root)
        keys = set(elements.list_elements(graph))
        chosen = [key for key in (self.selection if edited.select is None else edited.select) if key in keys]
        last = chosen[-1] if chosen else NO_ELEMENT
        active = last if edited.select is not None else self.active if self.active in keys else NO_ELEMENT
        self._add_step(edited.label, Snapshot(root, self.place, frozenset(chosen), active), edited.merge)

    def _add_step(self, label: str, after: Snapshot, merge: str = "") -> None:
        if not merge:
            self.seal()
        self.history.add(HistoryStep(label, self._snapshot, after, merge))
        self._move_to(after)

    def _move_to(self, snapshot: Snapshot) -> None:
        self._snapshot = snapshot
        self.revision += 1

    def _select(self, keys: Iterable[ElementId], active: ElementId) -> None:
        """Select elements that exist; the active one is `active` if it is among them, else the last."""
        existing = set(self.elements)
        chosen = [key for key in keys if key in existing]
        active = active if active in chosen else chosen[-1] if chosen else NO_ELEMENT
        if (frozenset(chosen), active) != (self.selection, self.active):
            self._move_to(Snapshot(self.root, self.place, frozenset(chosen), active))

    def _restart(self, root: Graph, path: Path | None, saved: Graph | None) -> None:
        """Open another document, which has no history."""
        self.history = History()
        self.path, self._saved, self._title = path, saved, ""
        self._bound, self._views, self._frame = {}, {}, None
        self._memo.clear()
        self.code_files.clear()
        self._move_to(Snapshot(root))

    def _read_file_again(self, label: str) -> None:
        if self.path is None:
            raise UsageError("this document has no file to read again")
        self.seal()
        root = load(self.path, self.types, sandbox=self.sandbox)
        before = self._snapshot
        self._saved = root
        self.code_files.clear()
        self._show_document(root)
        if root != before.root:
            self.history.add(HistoryStep(label, before, self._snapshot))

    def _show_document(self, root: Graph) -> None:
        """Show another document where this one was shown, as far as it has the same groups and elements."""
        place = self.place
        while place and not folding.is_place(root, place):
            place = place[:-1]
        keys = set(elements.list_elements(folding.body_at(root, place))) if place == self.place else set()
        self._move_to(Snapshot(root, place, self.selection & keys, self.active if self.active in keys else NO_ELEMENT))

    def _write_code(self, path: Path, text: str) -> Path:
        write_text_atomically(path, text, sandbox=self.sandbox)
        self.code_files.note(path, text)
        if self._saved is not None:
            self._saved = coding.set_file_code(self._saved, path, text, sandbox=self.sandbox)
            self.revision += 1
        return path

    def _follow_rename(self, old: ElementId, new: ElementId) -> None:
        """Let views and bound files follow an element to its new name; the old one stays for when that is undone."""
        old_end, new_end = old.port, new.port
        if old_end and new_end and old_end.node == INPUTS and not self.place and old_end.socket in self._bound:
            self._bound[new_end.socket] = self._bound[old_end.socket]

        def follow(port: Port) -> Port:
            return new_end or Port(new, port.socket) if old in (port.node, str(port)) else port

        for key, ports in self._views.items():
            if key[0] == self.place:
                self._views[key] = tuple(dict.fromkeys((*map(follow, ports), *ports)))

"""Code of nodes: what a person writes, and the files that it is in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from msgspec import structs

from ...custom_nodes import Code
from ...document.disk import read_text
from ...errors import DocumentError, GraphError
from ...graph import Graph
from ...resources.atomic_write import write_text_atomically
from ..edits import coding, folding, paths
from .state import State


class Coding(State):
    """Texts of nodes that are made of code.

    Code in a file may differ from the file until that is saved: then it is a draft. All nodes of a document that have
    their code in one file have the same text.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._on_disk: dict[Path, str] = {}
        self._mark = object()
        super().__init__(*args, **kwargs)

    def code(self, id: str) -> Code | None:
        """The code of a node; None for nodes that are made of none."""
        return coding.read_node_code(self.graph.nodes.get(id), self.graph.folder)

    def set_code(self, id: str, text: str, merge: str = "") -> None:
        """Give a node another text; links and values stay where their names do. Text that says no node is kept too.

        Texts with the same `merge` in a row make one step, as if only the last one had been written: what one of them
        made of links and values does not matter for the next.
        """
        before = self.history.snapshot_before(merge)
        root = self.root if before is None or before.place != self.place else before.root
        graph = folding.body_at(root, self.place)
        code = coding.read_node_code(graph.nodes.get(id), graph.folder)
        if code is None:
            raise GraphError(f"node '{id}' is not made of code")
        label = f"Edit code of {id}"
        if not code.file:
            self.edit(label, coding.set_code(graph, id, structs.replace(code, text=text)), merge=merge)
            return
        self._check_ours()
        after = coding.set_file_code(root, self._path(graph, code), text)
        if after != self.root:
            self._step(label, replace(self._now, root=after), merge)

    def inline_code(self, id: str) -> None:
        """Let the code of a node be part of the document; the file stays as it is."""
        code = self._code_in_file(id)
        self.edit(f"Move code of {id} into the graph", coding.set_code(self.graph, id, structs.replace(code, file="")))

    def export_code(self, id: str, path: str | Path) -> None:
        """Write the code of a node to a file, from which it comes from then on. Raises OutputError."""
        code = self.code(id)
        if code is None:
            raise GraphError(f"node '{id}' is not made of code")
        name = paths.relative(path, self.graph.folder)
        after = coding.set_code(self.graph, id, structs.replace(code, file=name))
        self._check_ours()
        write_text_atomically(Path(path), code.text)
        self._note(self._path(self.graph, structs.replace(code, file=name)), code.text)
        self.edit(f"Move code of {id} to {Path(path).name}", after)

    def save_code(self, id: str) -> Path:
        """Write the code of a node to its file; returns that. Raises OutputError."""
        path = self._path(self.graph, self._code_in_file(id))
        self._write(path, coding.file_texts(self.root)[path])
        return path

    def save_drafts(self) -> tuple[Path, ...]:
        """Write all code that differs from its file; returns the files. Raises OutputError."""
        drafts = self.drafts
        for path, text in drafts.items():
            self._write(path, text)
        return tuple(drafts)

    @property
    def drafts(self) -> Mapping[Path, str]:
        """Code that differs from the file that it belongs to, by file."""
        return self._kept(
            "drafts",
            (self.root, self._mark),
            lambda: MappingProxyType(
                {
                    path: text
                    for path, text in coding.file_texts(self.root).items()
                    if self._on_disk.get(path, text) != text
                }
            ),
        )

    @property
    def recoverable(self) -> Graph:
        """The document with drafts in it: nothing else would bring them back."""
        drafts = self.drafts
        return self._kept(
            "recoverable", (self.root, drafts), lambda: coding.embed_drafts(self.root, drafts) if drafts else self.root
        )

    def reread_code(self, path: Path) -> None:
        """Take over what another program wrote to a file of code, drafts of it included; this is no step."""
        self._on_disk.pop(path, None)
        self._transform(lambda graph: coding.reread_file_code(graph, path))
        self.note_code_files()

    def note_code_files(self) -> None:
        """Read what the files of code are, as far as that is not known yet."""
        for path in coding.file_texts(self.root):
            if path not in self._on_disk:
                try:
                    self._note(path, read_text(path))
                except DocumentError:
                    self._note(path, "")

    def differs_from_disk(self, path: Path) -> bool:
        """True if there is a draft of a file, and the file holds something else now."""
        if path not in self.drafts:
            return False
        try:
            return read_text(path) != self.drafts[path]
        except DocumentError:
            return True

    def keep_draft(self, path: Path) -> None:
        """A file was changed by another program; what is here stays, and is a draft now."""
        self._on_disk.pop(path, None)
        self.note_code_files()

    # --- inside ------------------------------------------------------------------------------------------------------

    def _code_in_file(self, id: str) -> Code:
        code = self.code(id)
        if code is None or not code.file:
            raise GraphError(f"the code of node '{id}' is in no file")
        return code

    def _path(self, graph: Graph, code: Code) -> Path:
        """The file that code is in."""
        return paths.full(code.file, graph.folder)

    def _write(self, path: Path, text: str) -> None:
        write_text_atomically(path, text)
        self._note(path, text)
        if self._saved is not None:
            self._saved = coding.set_file_code(self._saved, path, text)
            self._touch()

    def _note(self, path: Path, text: str) -> None:
        """That is what the file holds."""
        self._on_disk[path], self._mark = text, object()

    def _check_ours(self) -> None:
        """Raise GraphError within a group that comes from another file."""
        if found := folding.find_borrowed_group(self.root, self.place):
            raise GraphError(
                f"group '{found[0][-1]}' comes from the file '{found[1]}': make it local first, or open that file"
            )

    def _read_anew(self) -> None:
        self._on_disk, self._mark = {}, object()
        super()._read_anew()

    def _restart(self, root: Graph, path: Path | None, saved: Graph | None) -> None:
        self._on_disk, self._mark = {}, object()
        super()._restart(root, path, saved)

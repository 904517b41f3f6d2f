"""Finds the files that a picture was made from: by name at likely places, by hash in folders that the user names."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

from halation.nodes import Node
from halation.presets import paths as presets
from msgspec import Struct, structs

from ...compiler.lowering.references import CONFIG, find_path_texts
from ...errors import InputError, UsageError
from ...graph import INPUTS, Graph, did_you_mean
from ...graph.frames import Pattern
from ...graph.paths import change_paths, relocate_path
from ...resources.sandbox import Sandbox
from ..jobs.source_files import FileHashes
from .recipe import Recipe, RecordedFile, read_recipe

_FAR = "../../../"
"""A relative path that begins with three steps up is written as an absolute one. Chosen by judgement: farther away,
the common folder is rarely moved as a whole, which is what relative paths are for."""

State = Literal["same", "changed", "missing"]


class LocatedFile(Struct, frozen=True):
    """Where a recorded file is now and its hash; both are "" if it is missing. `path` of a sequence is its pattern."""

    recorded: RecordedFile
    state: State
    path: str = ""
    digest: str = ""


class FileFinder:
    """Finds the files of a recipe: where `given` says, by owner; else beside the picture, in the current folder, and
    below the folders of `search`, there under other names too.
    """

    def __init__(
        self, recipe: Recipe, chosen_paths: Mapping[str, str], search: Sequence[Path], sandbox: Sandbox
    ) -> None:
        self._recipe, self._search = recipe, search
        self._texts = {owner: text for owner, (text, _) in find_path_texts(recipe.graph).items()}
        self._chosen_paths = {self._resolve_owner(name): path for name, path in chosen_paths.items()}
        self._bases = (recipe.path.parent, Path(), *search, presets()[0].parent)
        self._hashes, self._sandbox = FileHashes(sandbox), sandbox
        self._files_by_hash: dict[str, str] | None = None

    def find_all(self) -> tuple[LocatedFile, ...]:
        """Find all files. Raises InputError for a path of the user where there is no file."""
        try:
            return tuple(self._find_file(recorded) for recorded in self._recipe.files)
        finally:
            self._hashes.close()

    def find_likely(self) -> tuple[LocatedFile, ...]:
        """The files with the right names at the likeliest places, without hashing them, which takes long."""
        return tuple(
            LocatedFile(recorded, "same", path)
            for recorded in self._recipe.files
            if (
                path := next(
                    (
                        path
                        for path in self._list_candidates(recorded)
                        if _exists(recorded, path, sandbox=self._sandbox)
                    ),
                    "",
                )
            )
        )

    def _resolve_owner(self, name: str) -> str:
        owners = {used.owner.removeprefix(f"{INPUTS}."): used.owner for used in self._recipe.files}
        if name in owners.values():
            return name
        if name not in owners:
            raise UsageError(f"-i {name}=...: the picture was made of no file called that{did_you_mean(name, owners)}")
        return owners[name]

    def _find_file(self, recorded: RecordedFile) -> LocatedFile:
        first = ""
        for path in self._list_candidates(recorded):
            located = self._inspect(recorded, path)
            if located and located.state == "same":
                return located
            first = first or (path if located else "")
            if recorded.owner in self._chosen_paths and not located:
                raise InputError(f"-i {recorded.owner.removeprefix(f'{INPUTS}.')}={path}: there is no such file")
        if recorded.owner not in self._chosen_paths and (path := self._find_by_content(recorded)):
            return self._inspect(recorded, path) or LocatedFile(recorded, "missing")
        return (self._inspect(recorded, first) if first else None) or LocatedFile(recorded, "missing")

    def _inspect(self, recorded: RecordedFile, path: str) -> LocatedFile | None:
        """The file at a path, or None; for a sequence, the path is that of one of its files or a pattern."""
        if not recorded.frames:
            if not _may_be_read(path, sandbox=self._sandbox):
                return None
            digest = self._hashes.hash_file(path)
            return LocatedFile(recorded, "same" if digest == recorded.digest else "changed", path, digest)
        pattern = Pattern.parse(path) or Pattern.parse(str(Path(path).with_name(recorded.pattern)))
        files = [pattern.name(frame) for frame in recorded.frames] if pattern else []
        if not pattern or not all(_may_be_read(file, self._sandbox) for file in files):
            return None
        digest = self._hashes.hash_files(files)
        return LocatedFile(recorded, "same" if digest == recorded.sequence_digest else "changed", pattern.text, digest)

    def _list_candidates(self, recorded: RecordedFile) -> Iterator[str]:
        """The paths where a file may be, the likeliest first."""
        if recorded.owner in self._chosen_paths:
            yield self._chosen_paths[recorded.owner]
            return
        name = recorded.pattern or recorded.name
        if text := self.find_text(recorded.owner):
            yield from (str(Path(base, text).with_name(name)) for base in self._bases)
        yield from (str(base / name) for base in self._bases)
        for top in self._search:
            for folder, _, names in os.walk(top):
                if recorded.name in names:
                    yield str(Path(folder, name))

    def _find_by_content(self, recorded: RecordedFile) -> str:
        """The path of a file with another name and the same hash below the named folders, or ""."""
        if recorded.frames:
            return ""
        if self._files_by_hash is None:
            self._files_by_hash = {}
            endings = {Path(item.name).suffix.casefold() for item in self._recipe.files}
            for top in self._search:
                for folder, _, names in os.walk(top):
                    files = (str(Path(folder, name)) for name in names if Path(name).suffix.casefold() in endings)
                    self._files_by_hash |= {
                        self._hashes.hash_file(file): file
                        for file in files
                        if _may_be_read(file, sandbox=self._sandbox)
                    }
        return self._files_by_hash.get(recorded.digest, "")

    def find_text(self, owner: str) -> str:
        """The path of an owner's file as the graph has it; "" if it has none."""
        return find_text(self._texts, owner)


def find_text(texts: Mapping[str, str], owner: str) -> str:
    """The text of an owner; a node without the name of a value stands for its only file."""
    return texts.get(owner) or next((text for name, text in texts.items() if name.rpartition(".")[0] == owner), "")


def load_graph_of_picture(path: Path, catalogue: Mapping[str, type[Node]] | None = None, *, sandbox: Sandbox) -> Graph:
    """The graph that made a picture, linked to its files if they are easy to find.

    Raises InputError, DocumentError: see `read_recipe`.
    """
    recipe = read_recipe(path, catalogue, sandbox=sandbox)
    return relink_files(recipe.graph, FileFinder(recipe, {}, (), sandbox=sandbox).find_likely())


def relink_files(graph: Graph, located_files: Sequence[LocatedFile]) -> Graph:
    """The graph with the paths of the files that were found, relative to its own folder."""
    texts = {owner: text for owner, (text, _) in find_path_texts(graph).items()}
    new_paths = {item.recorded.owner: _spell_path(item.path, graph.folder) for item in located_files if item.path}
    paths_by_text = {text: path for owner, path in new_paths.items() if (text := find_text(texts, owner))}
    graph = change_paths(graph, lambda text: paths_by_text.get(text, text))
    ends = dict(graph.inputs)
    for item in located_files:
        node, _, name = item.recorded.owner.partition(".")
        if node == INPUTS and name in ends and item.path:
            ends[name] = replace(ends[name], file=new_paths[item.recorded.owner], layer=item.recorded.layer)
    color = graph.settings.color
    if config := new_paths.get(CONFIG):
        color = structs.replace(color, config=config)
    return replace(graph, inputs=ends, settings=replace(graph.settings, color=color))


def _spell_path(path: str, folder: str) -> str:
    """The path of a file for a graph in a folder: relative if it is near."""
    full = os.path.abspath(path)  # noqa: PTH100
    near = relocate_path(os.path.relpath(full), "", folder) if _same_drive(full, folder) else full
    return full if near.startswith(_FAR) else near


def _same_drive(full: str, folder: str) -> bool:
    return Path(full).drive == Path(folder).absolute().drive == Path().absolute().drive


def _exists(recorded: RecordedFile, path: str, sandbox: Sandbox) -> bool:
    pattern = Pattern.parse(path) if recorded.frames else None
    return _may_be_read(pattern.name(recorded.frames[0]) if pattern else path, sandbox=sandbox)


def _may_be_read(path: str, sandbox: Sandbox) -> bool:
    """True for a file that is there, and not outside of the sandbox."""
    return not sandbox.find_read_fault(path) and Path(path).is_file() and os.access(path, os.R_OK)


def describe_missing(located_files: Sequence[LocatedFile], path: Path) -> InputError | None:
    """An error that names the missing files; None if there are none."""
    missing = [item.recorded for item in located_files if item.state == "missing"]
    if not missing:
        return None
    names = ", ".join(f"{used.pattern or used.name} ({used.owner.removeprefix(f'{INPUTS}.')})" for used in missing)
    owner = missing[0].owner.removeprefix(f"{INPUTS}.")
    return InputError(
        f"{path}: files that it was made from are missing: {names}; say where with -i {owner}=FILE, or "
        "name a folder to look in with --search DIR"
    )

"""Faults that appear when a graph is compiled: files that cannot be read, shaders, and the graph as a whole."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, TypeVar

from halation.nodes import ColorChange, ColorSettings, Missing, Render, Scene, TextBlock, TypesetText
from msgspec import Struct, field

from ..compiler import Request, examine, find_named_files
from ..errors import DeviceError, HalationError, InputError, ShaderError, UsageError
from ..graph import INPUTS, OUTPUTS, Graph, Group, Problem, find_key_range
from ..graph.enough import MAX_FINDINGS, Enough
from ..graph.rules import Rule
from ..resources.color_program import ColorProgram
from ..resources.input_files import open_file
from ..resources.mesh import Mesh
from ..resources.picture import Picture
from ..resources.provider import FrameFile, PictureProbe
from ..resources.sandbox import Sandbox
from ..resources.working_space import WorkingSpace
from .letters import MISSING_GLYPH, find_missing_glyphs
from .rules.paths import list_paths

if TYPE_CHECKING:
    from ..color.graph_faults import ColorFault
    from ..inputs.provider import MediaProvider

UNREADABLE_FILE = Rule(
    "unreadable-file",
    "error",
    "A file that the graph reads (a picture, a layer of it, a mesh, a table) does not exist, or cannot be read.",
    "Put the file there, or correct path and layer.",
)
LFS_POINTER = Rule(
    "lfs-pointer",
    "error",
    "A file is only the pointer that git LFS keeps in its place.",
    "Fetch the file with git lfs pull; in a workflow, check out with lfs: true.",
)
UNBOUND_INPUT = Rule(
    "unbound-input",
    "warning",
    "An input has neither a file nor a default: rendering needs -i NAME=FILE.",
    "Bind it when rendering, or allow it if the graph is made for that.",
)
CANNOT_COMPILE = Rule(
    "cannot-compile", "error", "The graph as a whole cannot be compiled.", "Do what the message says."
)
BAD_SETTING = Rule("bad-setting", "error", "A value is an unknown name, such as of a color space.", "Correct it.")
BROKEN_SHADER = Rule(
    "broken-shader",
    "error",
    "The shader of a node does not fit the declaration of the node, or includes a file that does not exist.",
    "Correct the shader.",
)
TOO_LARGE = Rule("too-large", "error", "A picture is larger than any device can hold.", "Make it smaller.")
RULES = (
    UNREADABLE_FILE,
    LFS_POINTER,
    UNBOUND_INPUT,
    CANNOT_COMPILE,
    BAD_SETTING,
    BROKEN_SHADER,
    TOO_LARGE,
    MISSING_GLYPH,
)

SIZE = (1920, 1080)
"""The size that is assumed for a missing picture."""

_POINTER = b"version https://git-lfs.github.com/spec/"
_POINTER_SIZE = 1024
"""How a pointer of git LFS begins, and the size in bytes that it never reaches (specification of git LFS)."""

T = TypeVar("T")


class NotingProvider(Struct, dict=True, eq=False):
    """The files that the compiler asks for. Each is read once, and one that cannot be read is noted."""

    sandbox: Sandbox
    faults: dict[str, str] = field(default_factory=dict[str, str])
    """Sentences about files, with the path of each as the graph has it."""
    _answers: dict[Any, Any] = field(default_factory=dict[Any, Any])
    _asked: dict[str, str] = field(default_factory=dict[str, str])
    """Paths as the graph has them, by the file of a frame."""
    _refused_files: dict[tuple[str, str], object] = field(default_factory=dict[tuple[str, str], object])
    """The question about a file whose header cannot be read: the answer for one layer is that for all of them. The
    folder that the file must lie in belongs to it, since a file may be refused for that alone."""
    size: tuple[int, int] = SIZE

    @cached_property
    def pictures(self) -> MediaProvider:
        """The provider that reads files, loaded on first use."""
        from ..inputs.provider import MediaProvider

        return MediaProvider(sandbox=self.sandbox)

    def first_frame(self, graph: Graph) -> int:
        """The first frame of a graph. A missing file of a sequence is noted."""
        if not any(self._is_sequence(path) for path, _, _ in find_named_files(graph, {})):
            return (graph.settings.frames or find_key_range(graph))[0]
        try:
            first, last = self.pictures.find_frames(graph, {})
            self.pictures.check_frames(graph, range(first, last + 1))
        except InputError as fault:
            self.faults[str(fault)] = ""
            return (graph.settings.frames or (1, 1))[0]
        return first

    def _is_sequence(self, path: str) -> bool:
        """False for a single picture, whether it exists or not."""

        def ask() -> bool:
            from ..media.sequences import find_sequence

            return find_sequence(path, sandbox=self.sandbox) is not None

        try:
            return self._answer("sequence", path, ask)
        except HalationError:
            return True

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """The file of a frame."""
        file = self._answer_or_note(
            path, ("at", path, frame, missing), lambda: self.pictures.find_frame_file(path, frame, missing)
        )
        shown_file = file or FrameFile(path)
        self._asked[shown_file.path] = path
        return shown_file

    def probe_picture(self, picture: Picture) -> PictureProbe:
        """Size and precision of a picture; assumed ones if it cannot be read."""
        path, file = picture.path, (picture.path, picture.within)
        if picture.in_memory:
            return PictureProbe(self.size, False, path)
        own_key = (*file, picture.layer, picture.kind, picture.width, picture.space, picture.color)
        key = self._refused_files.get(file, own_key)
        probe = self._answer_or_note(path, key, lambda: self.pictures.probe_picture(picture))
        if probe is None and not self.pictures.has_header(path):
            self._refused_files[file] = key
        return probe or PictureProbe(self.size, False, path)

    def write_color_program(self, change: ColorChange) -> ColorProgram:
        """The program of a color change."""
        return self._answer("recolor", change, lambda: self.pictures.write_color_program(change))

    def find_working_space(self, color: ColorSettings) -> WorkingSpace | None:
        """The constants of the working space for shaders."""
        return self._answer("working", color, lambda: self.pictures.find_working_space(color))

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        """The layers of a render's file."""
        return self._answer(path, tuple(sorted(named.items())), lambda: self.pictures.describe_render(path, named))

    def load_mesh(self, scene: Scene) -> Mesh:
        """The triangles of a scene."""
        return self._answer("mesh", scene, lambda: self.pictures.load_mesh(scene))

    def typeset(self, block: TextBlock) -> TypesetText:
        """The outlines of a text."""
        return self._answer("text", block, lambda: self.pictures.typeset(block))

    def read_attributes(self, path: str) -> Mapping[str, str]:
        """What the header of a picture says; nothing if it cannot be read."""
        return self._answer_or_note(path, ("header", path), lambda: self.pictures.read_attributes(path)) or {}

    def _answer_or_note(self, path: str, key: object, ask: Callable[[], T]) -> T | None:
        """The answer to a question, or None if there is none, which is noted."""
        try:
            return self._answer("once", key, ask)
        except InputError as fault:
            self.faults[str(_detach(fault))] = self._asked.get(path, path)
        if len(self.faults) > MAX_FINDINGS:
            raise ManyFilesError(f"more than {MAX_FINDINGS:,} files cannot be read: no others were looked for")
        return None

    def _answer(self, kind: str, key: object, ask: Callable[[], T]) -> T:
        """The answer to a question, remembered; so is a refusal."""
        if (kind, key) not in self._answers:
            try:
                self._answers[kind, key] = ask()
            except HalationError as fault:
                self._answers[kind, key] = _detach(fault)
        answer = self._answers[kind, key]
        if isinstance(answer, HalationError):
            raise answer
        return answer


class ManyFilesError(InputError):
    """So many files cannot be read that the others are not looked for."""


def _detach(fault: HalationError) -> HalationError:
    """A fault without what it came from, which would keep every local variable on the way: a graph may have many."""
    fault.__context__ = None
    return fault.with_traceback(None)


def problems(graph: Graph, world: NotingProvider, enough: Enough) -> Iterator[tuple[int, Problem]]:
    """The problems of a graph without errors, each with the exit code that rendering would have.

    Warnings that are not wanted any more are not looked for.
    """
    free = {name: item for name, item in graph.inputs.items() if not item.file and item.default is None}
    read = {source.socket for source in graph.links.values() if source.node == INPUTS}
    for name in free.keys() & read if enough.wants("warning") else ():
        sentence = f"input '{name}' has no file and no default: rendering needs -i {name}=FILE"
        yield 0, Problem(INPUTS, name, sentence, UNBOUND_INPUT, f"inputs.{name}")
    colors = list(_color_faults(graph, world.sandbox))
    for fault in colors:
        problem = Problem(fault.node, fault.name, str(fault.error), BAD_SETTING, fault.at)
        yield fault.error.exit_code, problem
    for problem in find_missing_glyphs(graph, world):
        if not enough.wants("warning"):
            break
        yield 0, problem
    if not graph.outputs or any(fault.node != OUTPUTS for fault in colors):
        return
    world.faults.clear()
    world.size = graph.settings.size or SIZE
    bindings = {name: Picture(name, "", item.kind, item.width, in_memory=True) for name, item in free.items()}
    try:
        examine(graph, Request(bindings=bindings, frame=world.first_frame(graph)), world)
    except ManyFilesError as fault:
        yield fault.exit_code, Problem("", "", str(fault), UNREADABLE_FILE)
    except InputError as fault:
        world.faults.setdefault(str(fault), "")
    except HalationError as fault:
        yield fault.exit_code, Problem(fault.node.partition(", ")[0], "", str(fault), _rule(fault))
    if world.faults:
        places = _places(graph)
        for sentence, path in world.faults.items():
            yield InputError.exit_code, _unreadable(sentence, path, places, world.sandbox)


def _color_faults(graph: Graph, sandbox: Sandbox) -> Iterator[ColorFault]:
    """Faults in names of color management. The library is loaded only if the graph has such names."""
    named = (*(end.view for end in graph.outputs.values()), *(end.color_space for end in graph.inputs.values()))
    if graph.settings.color != ColorSettings() or any(name not in ("", "none") for name in named):
        from ..color.graph_faults import find_color_faults

        yield from find_color_faults(graph, sandbox)


def _rule(fault: HalationError) -> Rule:
    kinds = ((ShaderError, BROKEN_SHADER), (DeviceError, TOO_LARGE), (UsageError, BAD_SETTING))
    return next((rule for kind, rule in kinds if isinstance(fault, kind)), CANNOT_COMPILE)


def _unreadable(sentence: str, path: str, places: Mapping[str, tuple[str, str, str]], sandbox: Sandbox) -> Problem:
    """The problem of a file, at the node or input that names it."""
    path = path or next(
        (candidate for candidate in sorted(places, key=len, reverse=True) if sentence.startswith(candidate)), ""
    )
    node, socket, at = places.get(path, ("", "", ""))
    if path and _is_pointer(path, sandbox):
        words = f"{path}: this is a pointer of git LFS, not the file itself: run git lfs pull"
        return Problem(node, socket, words, LFS_POINTER, at)
    return Problem(node, socket, sentence, UNREADABLE_FILE, at)


def _is_pointer(path: str, sandbox: Sandbox) -> bool:
    try:
        with open_file(path, sandbox) as file:
            return os.fstat(file.fileno()).st_size <= _POINTER_SIZE and file.read(len(_POINTER)) == _POINTER
    except (InputError, OSError, ValueError):
        return False


def _places(graph: Graph, inside: str = "", at: str = "", fixed: str = "") -> dict[str, tuple[str, str, str]]:
    """The first node or input that names each file, by the path of the file: node, socket and JSON path; `fixed` is the
    path for nodes inside another file."""
    places: dict[str, tuple[str, str, str]] = {}
    for node, socket, where, path in list_paths(graph):
        places.setdefault(str(PurePath(graph.folder, path)), (f"{inside}{node}", socket, fixed or f"{at}{where}"))
    for id, item in graph.nodes.items():
        if isinstance(item, Group):
            there = fixed or (f"{at}nodes.{id}.path" if item.path else "")
            for path, place in _places(item.graph, f"{inside}{id}/", f"{at}nodes.{id}.graph.", there).items():
                places.setdefault(path, place)
    return places

"""A script as data, and the walk over the graph that makes it."""

from __future__ import annotations

import builtins
import keyword
import re
from collections.abc import Mapping
from typing import Any

from halation.nodes import Kind, Node, Size
from msgspec import Struct, field

from ...compiler import Ref, Request, graph_library
from ...compiler.ir import Builder, Operand, PlannedObject
from ...compiler.lowering.graph_at_frames import GraphAtFrames
from ...compiler.lowering.lower import Lowering
from ...compiler.lowering.steps import LoweringStep, field_port
from ...errors import GraphError
from ...graph import Graph, Port, color_settings, is_animated
from ...graph.frames import is_video
from ...inputs.provider import MediaProvider
from ...media.sequences import find_sequence
from ..order import ExportOrder
from .library import load_library
from .missing import explain_missing
from .numbers import Plain
from .parts import find_read_frames

MAX_FRAMES = 240
"""Frames whose numbers a script holds, as many as other exports. Chosen by judgement: ten seconds."""


MAX_READ_FRAMES = 4 * MAX_FRAMES
"""Frames that a script may read in order to make these: the slider of `time_speed` ends at four times the speed."""


class PictureInput(Struct, frozen=True):
    """An input of the graph that the picture reads: its file, the layer, its channels and its size."""

    file: str
    layer: str
    channels: int
    size: Size
    is_numbered: bool = False
    """Whether each frame has a file of its own; `file` then has # in place of digits."""


class ScriptCall(Struct, frozen=True):
    """One line of the script: `targets = function(arguments)`."""

    targets: tuple[str, ...]
    function: str
    arguments: tuple[str, ...]


class ScriptClip(Struct):
    """A function of the script that makes a picture at any frame, because others read it at several."""

    name: str
    span: int
    """How many frames there are from the first to the last that is read for one frame of the result."""
    calls: list[ScriptCall] = field(default_factory=list[ScriptCall])
    results: tuple[str, ...] = ()


class ScriptOutline(Struct):
    """A script as data: the calls in order, tables of animated values by name, inputs, and what is returned."""

    size: Size
    frames: tuple[int, int]
    frame: int
    rate: float = 24.0
    preroll: int | None = None
    read_frames: tuple[int, int] = (1, 1)
    """The first and the last frame that is read in order to make `frames`."""
    calls: list[ScriptCall] = field(default_factory=list[ScriptCall])
    loop: list[ScriptCall] = field(default_factory=list[ScriptCall])
    """Calls for each frame from the first one: what nodes with a memory need, and these nodes."""
    memories: list[str] = field(default_factory=list[str])
    """The variables of what nodes remember."""
    clips: list[ScriptClip] = field(default_factory=list[ScriptClip])
    reads_inputs: bool = False
    """Whether functions read the inputs, at several frames; else `make_picture` is given them."""
    tables: dict[str, tuple[Plain, ...]] = field(default_factory=dict[str, "tuple[Plain, ...]"])
    inputs: dict[str, PictureInput] = field(default_factory=dict[str, PictureInput])
    functions: dict[str, None] = field(default_factory=dict[str, None])
    """The functions of nodes, by first use."""
    helpers: set[str] = field(default_factory=set[str])
    """Other functions that calls name."""
    choices: dict[tuple[str, str], set[str]] = field(default_factory=dict[tuple[str, str], "set[str]"])
    """The choices that nodes make, by function and parameter."""
    options: dict[tuple[str, str], set[str]] = field(default_factory=dict[tuple[str, str], "set[str]"])
    """All choices that they could make, by function and parameter."""
    switches: dict[tuple[str, str], set[bool]] = field(default_factory=dict[tuple[str, str], "set[bool]"])
    """The values that switches of nodes have, by function and parameter."""
    result: str = ""
    uses_frame: bool = False
    uses_rate: bool = False

    def list_calls(self) -> list[ScriptCall]:
        """All calls."""
        return [*(call for clip in self.clips for call in clip.calls), *self.loop, *self.calls]

    def note_choices(self, node: Node, name: str, values: tuple[Plain, ...]) -> None:
        """Enter what is chosen, so that functions need not hold the rest."""
        texts = {value for value in values if isinstance(value, str)}
        if texts:
            self.choices.setdefault((node.id, name), set()).update(texts)
            self.options.setdefault((node.id, name), set()).update(map(str, node.values[name].choices))
        self.switches.setdefault((node.id, name), set()).update(each for each in values if isinstance(each, bool))


class LoweredGraph:
    """A graph as the renderer sees it: flat nodes in order, with sizes. Raises GraphError where there can be no script.

    The compiler knows which nodes are needed, how large each picture is, and what a length is a part of.
    """

    def __init__(self, order: ExportOrder) -> None:
        _refuse_settings(order.graph)
        provider = MediaProvider(sandbox=order.sandbox)
        self.order, self.graph = order, order.graph
        self.bindings = provider.bind(self.graph, order.inputs)
        first, last = provider.find_frames(self.graph, self.bindings)
        self.frame = order.frame if order.frame is not None else first
        self.frames = min(first, self.frame), max(last, self.frame)
        self.rate = self.graph.settings.rate
        self.is_animated = is_animated(self.graph)
        if self.is_animated and self.frames[1] - self.frames[0] >= MAX_FRAMES:
            raise GraphError(f"its values are animated over more than {MAX_FRAMES} frames: name fewer in its settings")
        request = Request({"picture": order.target}, self.bindings, order.size, frame=self.frame)
        library = graph_library(self.graph, provider)
        self._lowering = Lowering(self.graph, request, library, provider, GraphAtFrames(self.graph), Builder())
        self.flat, self.at_frames = self._lowering.flat, self._lowering.frames
        self.source = self._lowering.find_sources()["picture"]
        self.paths = list(dict.fromkeys(path for path, _ in self._lowering.list_steps()))
        self._refuse_nodes()
        record = self._lowering.run()
        self._results = _prefer_exported_frame(record.results)
        self._steps = _prefer_exported_frame({key: step for key, step in record.steps.items() if key is not None})
        self._builder = record.builder
        self._refuse_cameras(record.results)
        self.canvas = record.canvas
        """The size of what has no size of its own, as far as anything asks for it."""
        self.output = record.program.outputs["picture"]
        self.read_frames, self.spans = find_read_frames(self.at_frames, self.source, self.frames)
        if self.is_animated and self.read_frames[1] - self.read_frames[0] >= MAX_READ_FRAMES:
            raise GraphError(
                f"its frames are made of more than {MAX_READ_FRAMES} frames with animated values: name fewer in its "
                "settings"
            )

    def result_of(self, port: Port) -> Operand:
        """What the compiler makes of a port, at the exported frame if it is read there."""
        return self._results[port]

    def field_of(self, port: Port) -> Operand | None:
        """The Field that a port carries besides its Image."""
        return self._results.get(field_port(port))

    def feeds_of(self, path: str) -> dict[str, Port]:
        """The source of each linked input and value of a node. It is the same at all frames."""
        return {name: source for name, (source, _) in self.at_frames.find_feeds((path, self.frame)).items()}

    def size_of(self, ref: Ref) -> Size:
        return self._builder.shape(ref).size

    def channels_of(self, ref: Ref) -> int:
        return self._builder.shape(ref).channels

    def is_data(self, ref: Ref) -> bool:
        return self._builder.shape(ref).data

    def step(self, path: str) -> LoweringStep:
        return self._steps[path]

    def nodes_at_frames(self, path: str) -> list[Node]:
        """A node at every frame that is read; only once if nothing moves."""
        if not self.is_animated:
            return [self.flat.nodes[path]]
        return [self.at_frames.node_at(path, frame) for frame in range(self.read_frames[0], self.read_frames[1] + 1)]

    def find_input(self, port: Port) -> PictureInput:
        """An input of the graph that is a picture. Raises GraphError for a file that a script cannot read."""
        socket, operand = self.flat.inputs[port], self.result_of(port)
        picture = self._lowering.pictures.named.find_bound(port, socket)
        assert picture is not None and isinstance(operand, Ref)
        path, sequence = picture.path, None
        if not picture.in_memory:
            if is_video(path):
                raise GraphError(f"the input '{port.socket}' is a video, and a script reads pictures: write its frames")
            sequence = find_sequence(path, sandbox=self.order.sandbox)
        if sequence is not None:
            if socket.missing == "black":
                raise GraphError(
                    f"the input '{port.socket}' is black where a frame is missing, and a script takes the nearest one: "
                    "choose hold or nearest"
                )
            pattern = sequence.pattern
            numbers = ["#" * max(width, 1) for width in pattern.widths]
            path = pattern.folder + "".join(
                piece + number for piece, number in zip(pattern.pieces, [*numbers, ""], strict=True)
            )
        size = self.size_of(operand)
        return PictureInput(path, picture.layer, self.channels_of(operand), size, sequence is not None)

    def gives_camera_of_file(self, path: str) -> bool:
        """True for a node of which only a camera is read that no function makes: it is a constant of the script."""
        if load_library().find_function(self.flat.nodes[path].id) is not None:
            return False
        read = {self.source} | {source for other in self.paths for source in self.feeds_of(other).values()}
        outputs = self.flat.nodes[path].outputs
        return all(outputs[port.socket].socket.kind is Kind.CAMERA for port in read if port.node == path)

    def is_written_anywhere(self, port: Port) -> bool:
        """True for what the text repeats wherever it is read: a number, or a camera of a file."""
        if port in self.flat.inputs:
            return not isinstance(self._results.get(port), Ref)
        return self.gives_camera_of_file(port.node)

    def _refuse_nodes(self) -> None:
        library, flat = load_library(), self.flat
        for path in self.paths:
            node = flat.nodes[path]
            if path in flat.muted or self.gives_camera_of_file(path):
                continue
            if library.find_function(node.id) is None:
                reason = explain_missing(node.id)
                fault = f"there is no numpy text for '{node.id}'" + (f" ({reason})" if reason else "")
                raise GraphError(f"node '{path}': {fault}: mute it, or write it with --to glsl", node=path)
            feeds = self.at_frames.find_feeds((path, self.frame))
            before = flat.nodes.get(feeds["image"][0].node) if "image" in feeds else None
            if node.id == "transform" and before is not None and before.id == "transform":
                fault = f"it joins with the transform '{feeds['image'][0].node}', and a script filters each of them"
                raise GraphError(f"node '{path}': {fault}: make one transform of both", node=path)

    def list_clips(self, path: str) -> set[str]:
        """The inputs that a node reads at several frames, but for cameras that are the same at all of them."""
        node = self.flat.nodes[path]
        names = node.times(self.frame) if path not in self.flat.muted else ()
        return {name for name in names if node.inputs[name].kind is not Kind.CAMERA or self.is_animated}

    def _refuse_cameras(self, results: Mapping[tuple[Port, int], Operand]) -> None:
        """Raise GraphError for a camera of a file that is read at several frames and is not the same there."""
        cameras: dict[Port, object] = {}
        for (port, _), camera in results.items():
            if not isinstance(camera, PlannedObject) or port in self.flat.inputs:
                continue
            if cameras.setdefault(port, camera.content) != camera.content and self.gives_camera_of_file(port.node):
                fault = "its camera is read at several frames, and a script has it as it is at one"
                raise GraphError(f"node '{port.node}': {fault}: write it with --to glsl", node=port.node)


class NameTable:
    """Names for variables: ids of nodes, as far as Python and the functions of the script leave them free."""

    def __init__(self) -> None:
        library = load_library()
        self._taken = {*library.definitions, *library.imports, *keyword.kwlist, *vars(builtins)}
        self._taken |= {"frame", "np", "width", "height", "main", "make_picture", "make_pictures", "first", "last"}
        self._taken |= {"at", "words", "read_input"}

    def choose(self, name_hint: str) -> str:
        """A free name that is like this one."""
        base = re.sub(r"\W+", "_", name_hint, flags=re.ASCII).strip("_").lower() or "picture"
        base = f"n{base}" if base[0].isdigit() else base
        name, number = base if base not in self._taken else f"{base}_out", 2
        while name in self._taken:
            name, number = f"{base}_{number}", number + 1
        self._taken.add(name)
        return name


def _prefer_exported_frame(items: Mapping[tuple[Any, int], Any]) -> dict[Any, Any]:
    """What there is at several frames once: at the exported frame, if it is there."""
    chosen: dict[Any, Any] = {}
    for (key, offset), item in items.items():
        if offset == 0 or key not in chosen:
            chosen[key] = item
    return chosen


def _refuse_settings(graph: Graph) -> None:
    color = color_settings(graph)
    if color.working or color.config:
        raise GraphError(
            "its settings choose a color config or a working space, and a script knows linear Rec.709 only"
        )
    if graph.settings.overscan:
        raise GraphError("its settings have overscan, and a picture of a script ends at its frame: set it to 0")

"""A script as data, and the walk over the graph that makes it."""

from __future__ import annotations

import builtins
import keyword
import re

from halation.nodes import Kind, Node, Size, Temporal
from msgspec import Struct, field

from ...compiler import Ref, Request, graph_library
from ...compiler.ir import Builder
from ...compiler.lowering.graph_at_frames import GraphAtFrames
from ...compiler.lowering.lower import Lowering
from ...compiler.lowering.steps import LoweringStep
from ...errors import GraphError
from ...graph import Graph, Port, color_settings, is_animated
from ...inputs.provider import MediaProvider
from ...resources.picture import Picture
from ..order import ExportOrder
from .library import load_library
from .missing import explain_missing
from .numbers import Plain

MAX_FRAMES = 240
"""Frames whose numbers a script holds, as many as other exports. Chosen by judgement: ten seconds."""


class PictureInput(Struct, frozen=True):
    """An input of the graph that the picture reads: its file, the layer, its channels and its size."""

    file: str
    layer: str
    channels: int
    size: Size


class ScriptCall(Struct, frozen=True):
    """One line of the script: `targets = function(arguments)`."""

    targets: tuple[str, ...]
    function: str
    arguments: tuple[str, ...]


class ScriptOutline(Struct):
    """A script as data: the calls in order, tables of animated values by name, inputs, and what is returned."""

    size: Size
    frames: tuple[int, int]
    frame: int
    calls: list[ScriptCall] = field(default_factory=list[ScriptCall])
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


class LoweredGraph:
    """A graph as the renderer sees it: flat nodes in order, with sizes. Raises GraphError where there can be no script.

    The compiler knows which nodes are needed, how large each picture is, and what a length is a part of.
    """

    def __init__(self, order: ExportOrder) -> None:
        _refuse_settings(order.graph)
        provider = MediaProvider(sandbox=order.sandbox)
        self.order, self.graph = order, order.graph
        self.bindings = provider.bind(self.graph, order.inputs)
        self.frames = self.graph.settings.frames or (1, 1)
        self.frame = order.frame if order.frame is not None else self.frames[0]
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
        self.steps, self.results, self._builder = record.steps, record.results, record.builder
        self.canvas = record.canvas
        """The size of what has no size of its own, as far as anything asks for it."""
        self.output = record.program.outputs["picture"]

    def size_of(self, ref: Ref) -> Size:
        return self._builder.shape(ref).size

    def channels_of(self, ref: Ref) -> int:
        return self._builder.shape(ref).channels

    def is_data(self, ref: Ref) -> bool:
        return self._builder.shape(ref).data

    def step(self, path: str) -> LoweringStep:
        return self.steps[path, 0]

    def nodes_at_frames(self, path: str) -> list[Node]:
        """A node at every frame of the graph; only once if nothing moves."""
        if not self.is_animated:
            return [self.flat.nodes[path]]
        return [self.at_frames.node_at(path, frame) for frame in range(self.frames[0], self.frames[1] + 1)]

    def find_picture(self, port: Port) -> Picture:
        """The file of an input of the graph."""
        picture = self._lowering.pictures.named.find_bound(port, self.flat.inputs[port])
        assert picture is not None
        return picture

    def gives_camera_of_file(self, path: str) -> bool:
        """True for a node of which only a camera is read that no function makes: it is a constant of the script."""
        if load_library().find_function(self.flat.nodes[path].id) is not None:
            return False
        read = {self.source} | {
            source for other in self.paths for source, _ in self.at_frames.find_feeds((other, self.frame)).values()
        }
        outputs = self.flat.nodes[path].outputs
        return all(outputs[port.socket].socket.kind is Kind.CAMERA for port in read if port.node == path)

    def _refuse_nodes(self) -> None:
        library, flat = load_library(), self.flat
        for path in self.paths:
            node = flat.nodes[path]
            if path in flat.muted or self.gives_camera_of_file(path):
                continue
            if isinstance(node, Temporal) or (node.times(self.frame) and not self._stands_still(path)):
                fault = "it reads other frames, and a script makes each frame alone"
                raise GraphError(f"node '{path}': {fault}: mute it, or write it with --to glsl", node=path)
            if library.find_function(node.id) is None:
                reason = explain_missing(node.id)
                fault = f"there is no numpy text for '{node.id}'" + (f" ({reason})" if reason else "")
                raise GraphError(f"node '{path}': {fault}: mute it, or write it with --to glsl", node=path)
            feeds = self.at_frames.find_feeds((path, self.frame))
            before = flat.nodes.get(feeds["image"][0].node) if "image" in feeds else None
            if node.id == "transform" and before is not None and before.id == "transform":
                fault = f"it joins with the transform '{feeds['image'][0].node}', and a script filters each of them"
                raise GraphError(f"node '{path}': {fault}: make one transform of both", node=path)

    def _stands_still(self, path: str) -> bool:
        """True for a node that reads at other frames only cameras, which are the same there."""
        node = self.flat.nodes[path]
        return not self.is_animated and all(node.inputs[name].kind is Kind.CAMERA for name in node.times(self.frame))


class NameTable:
    """Names for variables: ids of nodes, as far as Python and the functions of the script leave them free."""

    def __init__(self) -> None:
        library = load_library()
        self._taken = {*library.definitions, *library.imports, *keyword.kwlist, *vars(builtins)}
        self._taken |= {"frame", "np", "width", "height", "main", "make_picture"}

    def choose(self, name_hint: str) -> str:
        """A free name that is like this one."""
        base = re.sub(r"\W+", "_", name_hint, flags=re.ASCII).strip("_").lower() or "picture"
        base = f"n{base}" if base[0].isdigit() else base
        name, number = base if base not in self._taken else f"{base}_out", 2
        while name in self._taken:
            name, number = f"{base}_{number}", number + 1
        self._taken.add(name)
        return name


def _refuse_settings(graph: Graph) -> None:
    color = color_settings(graph)
    if color.working or color.config:
        raise GraphError(
            "its settings choose a color config or a working space, and a script knows linear Rec.709 only"
        )
    if graph.settings.overscan:
        raise GraphError("its settings have overscan, and a picture of a script ends at its frame: set it to 0")

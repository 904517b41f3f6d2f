"""Builds graphs around one node: to plan it alone, and to show it on the sample picture."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

from halation.nodes import ColorSettings, Kind, Matte, Missing, Node, Render, Size, Socket, Source, catalogue

from ..compiler import NULL, Plan, Request, Target, compile_graph
from ..errors import ShaderError
from ..graph import Graph, Input, Output, Port, Settings
from ..inputs.lazy_provider import LazyResourceProvider
from ..resources.picture import Picture
from ..resources.provider import FrameFile, PictureProbe
from ..resources.sandbox import UNRESTRICTED

NODE = "node"
"""The id that the node has in these graphs."""

FULL_HD = (1920, 1080)
"""HDTV (ITU-R BT.709)."""

BUILT_IN = ColorSettings("ocio://default")
"""A fixed color config, so that the plan of a node does not depend on $OCIO."""

CANVAS = (480, 270)
"""The size of the sample."""

_DATA = MappingProxyType({"depth": "Depth", "ids": "Object Index"})
"""Layers of the sample for inputs of these names."""

_ROLES = (
    "beauty",
    "albedo",
    "emission",
    "occlusion",
    "position",
    "object_id",
    "material_id",
    "uv",
    "depth",
    "normal",
    "velocity",
)
"""Layers that a render may have."""


class _SamplePictures(LazyResourceProvider):
    """A provider whose pictures all have the same size and all layers."""

    def __init__(self, size: Size) -> None:
        super().__init__(UNRESTRICTED)
        self._size = size

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """The file of every frame is the path itself."""
        return FrameFile(path)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        """The size of every picture, without reading a file."""
        return PictureProbe(self._size, True, picture.path)

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        """A render with every layer that a node may need."""
        mattes = tuple(f"CryptoObject{rank:02}" for rank in range(3))
        return Render({role: role for role in _ROLES}, dict.fromkeys(_ROLES, 4), mattes=(Matte("object", mattes, {}),))


def drawable_outputs(node: type[Node]) -> tuple[str, ...]:
    """The outputs that can be rendered: all except planned ones, such as cameras."""
    return tuple(name for name, output in node.outputs.items() if not output.socket.kind.is_planned)


def plan_node(
    node: type[Node], size: Size, target: Target = NULL, values: Mapping[str, Any] = MappingProxyType({})
) -> Plan:
    """Plan all outputs of a node, at its defaults but for `values`, with inputs of this size. Needs no OpenGL.

    Raises GraphError for a node that draws nothing.
    """
    graph = Graph(settings=Settings(size, color=BUILT_IN)).add(
        NODE, node(**_path_values(node, "picture.exr"), **values)
    )
    pictures: dict[str, Picture] = {}
    for name, socket in node.inputs.items():
        if socket.optional:
            continue
        if socket.kind is Kind.CAMERA:
            graph = _link_new_node(graph, name, "camera", "camera")
            continue
        graph = _link_input(
            graph, name, name, Input(socket.kind, socket.channels, default=0.0 if socket.single else None)
        )
        if not socket.single:
            pictures[name] = Picture(name, "", socket.kind, socket.channels, in_memory=True)
    targets = {name: Port(NODE, name) for name in drawable_outputs(node)}
    with name_specimen(node):
        return compile_graph(graph, Request(targets, pictures), _SamplePictures(size), target=target)


@contextmanager
def name_specimen(node: type[Node]) -> Generator[None]:
    """Errors of shaders name the type of the node inside this context: nobody knows its id in a graph made for it."""
    try:
        yield
    except ShaderError as error:
        raise ShaderError(node.id, error.file, error.line, error.fault) from None


def show_on_sample(node: type[Node], sample: Path) -> Graph:
    """A graph that shows a node at its defaults on the sample picture; its outputs are those of the node.

    The main image is the sample's color, a second image a glow. Fields are the sample's depth, ids or luminance;
    vectors its positions, normals or motion, or noise; an input of texture coordinates gets a swirl.
    """
    graph = Graph(settings=Settings(CANVAS)).add(NODE, node(**_path_values(node, str(sample))))
    needed = {name: socket for name, socket in node.inputs.items() if _is_needed(node, socket)}
    images = [name for name, socket in needed.items() if socket.kind is Kind.IMAGE]
    base_input = "image" if "image" in images else next(reversed(images), "")
    for name, socket in needed.items():
        if socket.kind is Kind.IMAGE and name != base_input:
            graph = _link_new_node(
                graph,
                name,
                "ramp",
                "out",
                shape="radial",
                start=(0.3, 0.4),
                end=(0.75, 0.4),
                first=(1.0, 0.35, 0.1, 1.0),
                second=(0.0, 0.0, 0.0, 0.0),
            )
        elif socket.kind is Kind.IMAGE:
            graph = _link_input(graph, name, "beauty", _sample_input(Kind.IMAGE, 4, sample, "Combined"))
        elif name in _DATA:
            graph = _link_input(graph, name, name, _sample_input(Kind.FIELD, 1, sample, _DATA[name]))
        elif socket.kind is Kind.FIELD:
            graph = _link_new_node(graph, name, "luminance", "out")
            graph = _link_input(
                graph, "image", "beauty", _sample_input(Kind.IMAGE, 4, sample, "Combined"), f"{name}_luminance"
            )
        elif socket.kind is Kind.VECTOR:
            graph = _link_vector(graph, name, socket, sample)
        elif socket.kind is Kind.CAMERA:
            graph = _link_new_node(graph, name, "solve_camera", "camera", path=str(sample))
        else:
            graph = _link_input(graph, name, name, Input(socket.kind, default=0.5))
    # The file of a source may lack what its other outputs need.
    for name in drawable_outputs(node)[:1] if issubclass(node, Source) else drawable_outputs(node):
        output = Output(node.outputs[name].socket.kind, node.outputs[name].socket.channels)
        graph = graph.add_output(name, output).connect(Port(NODE, name), Port("outputs", name))
    return graph


def sample_graph(sample: Path) -> Graph:
    """A graph whose output is the sample's color."""
    graph = Graph().add_input("beauty", _sample_input(Kind.IMAGE, 4, sample, "Combined")).add_output("image", Output())
    return graph.connect(Port("inputs", "beauty"), Port("outputs", "image"))


def _is_needed(node: type[Node], socket: Socket) -> bool:
    """True if the node has no visible effect without a link to this input."""
    images = [name for name, input in node.inputs.items() if input.kind is Kind.IMAGE]
    is_black = socket.default == 0.0 or (socket.default == (0.0, 0.0, 0.0, 0.0) and images == [socket.name])
    does_nothing = is_black and all(input.optional for input in node.inputs.values())
    is_absent = socket.kind is Kind.VECTOR and socket.name != "material"  # the sample has no such layer
    return not socket.optional or does_nothing or is_absent or (socket.name == "mask" and not socket.default)


def _link_vector(graph: Graph, name: str, socket: Socket, sample: Path) -> Graph:
    """Link a vector input to a layer of the sample, to noise, or to texture coordinates with a swirl."""
    if socket.channels == 3:
        key = "position" if name == "position" else "normal"
        return _link_input(graph, name, key, _sample_input(Kind.VECTOR, 3, sample, key.capitalize()))
    if socket.channels == 4:
        return _link_input(graph, name, "motion", _sample_input(Kind.VECTOR, 4, sample, "Vector"))
    if name not in ("st", "uv"):
        return _link_new_node(graph, name, "noise", "vector")
    graph, map = _link_new_node(graph, name, "combine_vector2", "vector"), f"{name}_combine_vector2"
    graph = (
        graph.add("positions", _make_node("combine"))
        .add("stirred", _make_node("swirl"))
        .add("parts", _make_node("separate"))
    )
    graph = graph.add("across", _make_node("ramp")).add("up", _make_node("ramp", start=(0.5, 1.0), end=(0.5, 0.0)))
    links = {
        "positions.red": "across.value",
        "positions.green": "up.value",
        "stirred.image": "positions.out",
        "parts.image": "stirred.out",
        f"{map}.x": "parts.red",
        f"{map}.y": "parts.green",
    }
    for target, source in links.items():
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


def _link_new_node(graph: Graph, name: str, kind: str, output: str, **values: Any) -> Graph:
    """Link an input of the node to a new node."""
    id = f"{name}_{kind}"
    return graph.add(id, _make_node(kind, **values)).connect(Port(id, output), Port(NODE, name))


def _link_input(graph: Graph, name: str, graph_input: str, input: Input, id: str = NODE) -> Graph:
    """Link an input of a node to an input of the graph, which is added unless it exists."""
    graph = graph if graph_input in graph.inputs else graph.add_input(graph_input, input)
    return graph.connect(Port("inputs", graph_input), Port(id, name))


def _make_node(kind: str, **values: Any) -> Node:
    return catalogue()[kind](**values)


def _sample_input(kind: Kind, width: int, sample: Path, layer: str) -> Input:
    return Input(kind, width, str(sample), layer)


def _path_values(node: type[Node], path: str) -> dict[str, Any]:
    """The picture as the path values of a source, else no values."""
    paths = (name for name, value in node.values.items() if value.type == "path")
    return dict.fromkeys(paths, path) if issubclass(node, Source) else {}

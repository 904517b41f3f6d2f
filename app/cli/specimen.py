"""Graphs that show one node at work: alone, to be planned, and over a picture, to be looked at."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from halation.nodes import ColorSettings, Kind, Matte, Missing, Node, Render, Size, Socket, Source, catalogue

from ..compiler import NULL, Plan, Request, Target, compile_graph
from ..graph import Graph, Input, Output, Port, Settings
from ..inputs.lazy_provider import LazyResourceProvider
from ..resources.picture import Picture
from ..resources.provider import FrameFile, PictureProbe

NODE = "node"
"""The id that the node has in these graphs."""

FULL_HD = (1920, 1080)

BUILT_IN = ColorSettings("ocio://default")
"""What a node compiles to is the same whatever $OCIO names."""

CANVAS = (480, 270)
"""As large as the sample."""

_DATA = MappingProxyType({"depth": "Depth", "ids": "Object Index"})
"""Layers of the sample that fields of these names are for."""

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


class _SameSize(LazyResourceProvider):
    """A world in which all pictures have the same size."""

    def __init__(self, size: Size) -> None:
        self._size = size

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """There is one picture."""
        return FrameFile(path)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        """Nothing is read."""
        return PictureProbe(self._size, True, picture.path)

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        """Every layer that a node may ask for is there."""
        mattes = tuple(f"CryptoObject{rank:02}" for rank in range(3))
        return Render({role: role for role in _ROLES}, dict.fromkeys(_ROLES, 4), mattes=(Matte("object", mattes, {}),))


def drawable_outputs(node: type[Node]) -> tuple[str, ...]:
    """The outputs that can be rendered: all but those that are only planned, such as cameras."""
    return tuple(name for name, output in node.outputs.items() if not output.socket.kind.is_planned)


def plan_node(node: type[Node], size: Size, target: Target = NULL) -> Plan:
    """What a node compiles to at its defaults, all that it draws wanted, over pictures of that size. Needs no OpenGL.

    Raises GraphError for a node that draws nothing.
    """
    graph = Graph(settings=Settings(size, color=BUILT_IN)).add(NODE, node(**_path_values(node, "picture.exr")))
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
    return compile_graph(graph, Request(targets, pictures), _SameSize(size), target=target)


def show_on_sample(node: type[Node], sample: Path) -> Graph:
    """A node at its defaults with everything that it takes to see it, its outputs those of the graph.

    The picture is the sample's color; a picture to lay upon it is a glow. Fields are its depth, ids or luminance,
    vectors its positions, normals or motion, or random; maps of positions stir the picture.
    """
    graph = Graph(settings=Settings(CANVAS)).add(NODE, node(**_path_values(node, str(sample))))
    needed = {name: socket for name, socket in node.inputs.items() if _is_needed(node, socket)}
    images = [name for name, socket in needed.items() if socket.kind is Kind.IMAGE]
    base = "image" if "image" in images else next(reversed(images), "")
    for name, socket in needed.items():
        if socket.kind is Kind.IMAGE and name != base:
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
            graph = _link_input(graph, name, "beauty", _layer(Kind.IMAGE, 4, sample, "Combined"))
        elif name in _DATA:
            graph = _link_input(graph, name, name, _layer(Kind.FIELD, 1, sample, _DATA[name]))
        elif socket.kind is Kind.FIELD:
            graph = _link_new_node(graph, name, "luminance", "out")
            graph = _link_input(
                graph, "image", "beauty", _layer(Kind.IMAGE, 4, sample, "Combined"), f"{name}_luminance"
            )
        elif socket.kind is Kind.VECTOR:
            graph = _vector(graph, name, socket, sample)
        elif socket.kind is Kind.CAMERA:
            graph = _link_new_node(graph, name, "solve_camera", "camera", path=str(sample))
        else:
            graph = _link_input(graph, name, name, Input(socket.kind, default=0.5))
    # A file may not hold all that its reader could show.
    for name in drawable_outputs(node)[:1] if issubclass(node, Source) else drawable_outputs(node):
        end = Output(node.outputs[name].socket.kind, node.outputs[name].socket.channels)
        graph = graph.add_output(name, end).connect(Port(NODE, name), Port("outputs", name))
    return graph


def sample_graph(sample: Path) -> Graph:
    """The sample's color as it is."""
    graph = Graph().add_input("beauty", _layer(Kind.IMAGE, 4, sample, "Combined")).add_output("image", Output())
    return graph.connect(Port("inputs", "beauty"), Port("outputs", "image"))


def _is_needed(node: type[Node], socket: Socket) -> bool:
    """True if the node shows nothing of what it can do without a link to this input."""
    idle = socket.default == 0.0 and all(other.optional for other in node.inputs.values())
    lies = socket.kind is Kind.VECTOR and socket.name != "material"  # the sample has none of that
    return not socket.optional or idle or lies or (socket.name == "mask" and not socket.default)


def _vector(graph: Graph, name: str, socket: Socket, sample: Path) -> Graph:
    """Feed a vector."""
    if socket.channels == 3:
        key = "position" if name == "position" else "normal"
        return _link_input(graph, name, key, _layer(Kind.VECTOR, 3, sample, key.capitalize()))
    if socket.channels == 4:
        return _link_input(graph, name, "motion", _layer(Kind.VECTOR, 4, sample, "Vector"))
    if name not in ("st", "uv"):
        return _link_new_node(graph, name, "noise", "vector")
    graph, map = _link_new_node(graph, name, "combine_vector2", "vector"), f"{name}_combine_vector2"
    graph = graph.add("positions", _node("combine")).add("stirred", _node("swirl")).add("parts", _node("separate"))
    graph = graph.add("across", _node("ramp")).add("up", _node("ramp", start=(0.5, 1.0), end=(0.5, 0.0)))
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
    """Feed an input of the node by another node."""
    id = f"{name}_{kind}"
    return graph.add(id, _node(kind, **values)).connect(Port(id, output), Port(NODE, name))


def _link_input(graph: Graph, name: str, key: str, end: Input, id: str = NODE) -> Graph:
    """Feed an input of a node by an input of the graph, which may be there already."""
    graph = graph if key in graph.inputs else graph.add_input(key, end)
    return graph.connect(Port("inputs", key), Port(id, name))


def _node(kind: str, **values: Any) -> Node:
    return catalogue()[kind](**values)


def _layer(kind: Kind, width: int, sample: Path, layer: str) -> Input:
    return Input(kind, width, str(sample), layer)


def _path_values(node: type[Node], path: str) -> dict[str, Any]:
    """The picture there as a value, for a node that reads pictures."""
    paths = (name for name, value in node.values.items() if value.type == "path")
    return dict.fromkeys(paths, path) if issubclass(node, Source) else {}

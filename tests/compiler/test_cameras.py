"""Cameras on links: known while compiling, through groups, and no pictures."""

from __future__ import annotations

import pytest
from halation.compiler import Request
from halation.compiler.library import Library, parse
from halation.compiler.lowering.lower import lower
from halation.errors import GraphError
from halation.graph import Graph, Group, Input, Output, Port
from halation.nodes import CameraModel, CameraSocket, Draw, Drawn, Field, Filter, Image, Kind, look_at
from halation.nodes.input.camera import Camera as CameraNode
from halation.resources.picture import Picture
from headers import Headers

SEEN: list[CameraModel | None] = []


class Watcher(Filter):
    """Notes the camera that it is given."""

    image = Image()
    camera = CameraSocket(0.0)

    def passes(self, draw: Draw) -> Drawn:
        SEEN.append(draw.camera(self.camera))
        return draw.blur(self.image, 1.0)


def seen(graph: Graph) -> CameraModel | None:
    """The camera that the watcher of a graph is given."""
    SEEN.clear()
    library = Library({"primitive/convert": parse("primitive/convert", "")})
    bindings = {"image": Picture("image", "", Kind.IMAGE, 4, in_memory=True)}
    asked = Request({"out": Port("watcher", "out")}, bindings)
    lower(graph, asked, library, Headers((32, 18)))
    return SEEN[0]


def watched() -> Graph:
    graph = Graph().add("watcher", Watcher()).add_input("image", Input())
    return graph.connect(Port("inputs", "image"), Port("watcher", "image"))


NODE = CameraNode(eye=(1.0, -5.0, 2.0), target=(0.0, 0.0, 1.0), focal=36.0, sensor=36.0)
WANTED = look_at((1.0, -5.0, 2.0), (0.0, 0.0, 1.0), (1.0, 32 / 18))


def test_a_camera_is_known_to_the_node_that_takes_it() -> None:
    graph = watched().add("camera", NODE).connect(Port("camera", "camera"), Port("watcher", "camera"))
    assert seen(graph) == WANTED
    assert seen(watched()) is None


def test_the_plan_says_which_cameras_nodes_were_given(plan) -> None:
    graph = watched().add("camera", NODE).connect(Port("camera", "camera"), Port("watcher", "camera"))
    wanted = {"out": Port("watcher", "out")}
    SEEN.clear()
    assert plan(graph, targets=wanted).cameras == {Port("watcher", "camera"): SEEN[0]}
    assert SEEN[0] is not None
    assert plan(graph.mute("camera", True), targets=wanted).cameras == {}


def test_it_goes_into_groups_and_out_of_them() -> None:
    inner = Graph().add("camera", NODE).add_output("camera", Output(Kind.CAMERA))
    inner = inner.connect(Port("camera", "camera"), Port("outputs", "camera"))
    graph = watched().add("group", Group(inner)).connect(Port("group", "camera"), Port("watcher", "camera"))
    assert seen(graph) == WANTED


def test_a_graph_input_holds_one() -> None:
    graph = watched().add_input("camera", Input(Kind.CAMERA, default=WANTED.rows))
    assert seen(graph.connect(Port("inputs", "camera"), Port("watcher", "camera"))) == WANTED


def test_a_muted_camera_is_none() -> None:
    graph = watched().add("camera", NODE).connect(Port("camera", "camera"), Port("watcher", "camera"))
    assert seen(graph.mute("camera", True)) is None


def test_it_is_no_picture_and_nothing_else_is_a_camera(plan) -> None:
    graph = Graph().add("camera", NODE)
    with pytest.raises(GraphError, match="is a camera, which is no picture"):
        plan(graph, targets={"out": Port("camera", "camera")})
    for socket in (Image(), Field()):
        other = Graph().add_input("x", Input(socket.kind)).add("watcher", Watcher())
        with pytest.raises(GraphError, match="does not fit a Camera"):
            other.connect(Port("inputs", "x"), Port("watcher", "camera"))
    with pytest.raises(GraphError, match="a Camera does not fit an Image"):
        graph.add("watcher", Watcher()).connect(Port("camera", "camera"), Port("watcher", "image"))

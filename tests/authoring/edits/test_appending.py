"""Nodes behind what is selected: linked, in free room, several a chain; files in a column; sockets of the same name."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
from halation import presets
from halation.authoring.commands import (
    AddNode,
    AppendNode,
    Connect,
    ConnectNodes,
    DropFiles,
    MakeGroup,
    ReplaceGraph,
)
from halation.authoring.edits.appending import estimate_sizes
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.layout import positions
from halation.authoring.session import Session
from halation.editor.canvas.layout import NodeFacts, make_node_layout
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind, catalogue
from halation.render_layers.render import read_render
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

NEON = presets.paths()[0].parent / "samples" / "neon.exr"


@pytest.fixture
def session() -> Session:
    return Session(sandbox=UNRESTRICTED)


def append(session: Session, kind: str) -> str:
    return session.apply(AppendNode(AddNode(kind, (10.0, 10.0))))


def find_overlaps(graph: Graph) -> list[tuple[str, str]]:
    """Nodes whose boxes, as the canvas draws them with thumbnails, cover each other."""
    places, boxes = positions(graph), {}
    for id, item in graph.nodes.items():
        layout = make_node_layout(id, item, graph, NodeFacts(picture=True))
        x, y = places[ElementId(id)]
        boxes[id] = (x, y, x + layout.width, y + layout.height)
    return [
        (first, second)
        for (first, a), (second, b) in combinations(boxes.items(), 2)
        if a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
    ]


def test_several_in_a_row_make_a_chain_that_feeds_the_output(session: Session) -> None:
    ids = [append(session, kind) for kind in ("constant", "bloom", "vignette", "film_grain", "exposure")]
    links = session.graph.links
    assert [links[Port(id, "image")].node for id in ids[1:]] == ids[:-1]
    assert links[Port("outputs", "image")] == Port(ids[-1], "out")
    assert not find_overlaps(session.graph)
    left = [session.positions[ElementId(id)][0] for id in ids]
    assert left == sorted(left) and len(set(left)) == len(left)
    assert session.selection == {ElementId(ids[-1])}
    session.undo()
    assert ids[-1] not in session.graph.nodes and not any(target.node == ids[-1] for target in session.graph.links)


def test_an_output_of_the_graph_moves_behind_the_new_node(session: Session) -> None:
    first = append(session, "constant")
    assert session.graph.links == {Port("outputs", "image"): Port(first, "out")}  # nothing fed it
    second = append(session, "vignette")
    assert session.graph.links[Port("outputs", "image")] == Port(second, "out")
    assert session.positions[ElementId.of("output", "image")][0] > session.positions[ElementId(second)][0]


def test_the_viewer_goes_along_where_it_shows_what_feeds_the_new_node(session: Session) -> None:
    first = append(session, "constant")
    assert session.views.find_port() == Port("outputs", "image")  # which shows what is new in any case
    session.views.show(Port(first, "out"))
    second = append(session, "vignette")
    assert session.views.find_port() == Port(second, "out")
    session.undo()
    assert session.views.find_port() == Port(first, "out")
    session.redo()
    assert session.views.find_port() == Port(second, "out")
    session.apply(MakeGroup())  # of the vignette
    assert session.views.find_port() == Port("group", "out")
    session.undo()
    assert session.views.find_port() == Port(second, "out")
    session.select(())
    lone = append(session, "roto")
    session.views.show(Port(lone, "out"))
    session.apply(MakeGroup())  # of what nobody reads
    assert session.views.find_port() == Port("group", "out")
    session.undo()
    session.views.show(Port(second, "out"))
    session.select([ElementId(second)])
    append(session, "merge")  # its background is not linked yet
    assert session.views.find_port() == Port(second, "out")
    session.select([ElementId(first)])
    append(session, "exposure")
    assert session.views.find_port() == Port(second, "out")  # the user looks at something else


def test_a_node_that_feeds_others_keeps_its_links(session: Session) -> None:
    first = append(session, "constant")
    second = append(session, "vignette")
    session.select(ElementId(first))
    third = append(session, "exposure")
    assert session.graph.links[Port(second, "image")].node == first
    assert session.graph.links[Port(third, "image")].node == first
    assert not find_overlaps(session.graph)


def test_two_selected_nodes_feed_two_inputs(session: Session) -> None:
    ids = []
    for _ in range(2):
        session.select(())
        ids.append(append(session, "constant"))
    session.select([ElementId(id) for id in ids])
    merged = append(session, "merge")
    assert {source.node for target, source in session.graph.links.items() if target.node == merged} == set(ids)
    assert not find_overlaps(session.graph)


def test_what_takes_no_picture_is_not_linked_and_covers_nothing(session: Session) -> None:
    ids = [append(session, "constant") for _ in range(4)]
    assert set(session.graph.links) == {Port("outputs", "image")}  # of the first one
    assert len(ids) == 4 and not find_overlaps(session.graph)


def test_sockets_of_the_same_name_are_linked_at_once(session: Session) -> None:
    render = append(session, "read_render")
    session.select(())
    occlusion = append(session, "ambient_occlusion")
    session.apply(ConnectNodes(Port(render, "depth"), Port(occlusion, "depth")))
    fed = {target.socket: str(source) for target, source in session.graph.links.items() if target.node == occlusion}
    assert fed == {name: f"{render}.{name}" for name in ("depth", "normal", "camera", "albedo")}
    assert len(session.history.steps) == 3  # two nodes and one link


def test_a_link_that_is_there_stays(session: Session) -> None:
    render = append(session, "read_render")
    session.select(())
    gray = append(session, "constant")
    session.select(())
    occlusion = append(session, "ambient_occlusion")
    session.apply(Connect(Port(gray, "out"), Port(occlusion, "albedo")))
    session.apply(ConnectNodes(Port(render, "depth"), Port(occlusion, "depth")))
    assert session.graph.links[Port(occlusion, "albedo")].node == gray
    assert session.graph.links[Port(occlusion, "normal")].node == render


def test_occlusion_behind_a_selected_render_takes_all_its_layers(session: Session) -> None:
    render = append(session, "read_render")
    occlusion = append(session, "ambient_occlusion")
    fed = {target.socket: source.socket for target, source in session.graph.links.items() if target.node == occlusion}
    assert fed == {name: name for name in ("depth", "normal", "camera", "albedo")}
    assert not find_overlaps(session.graph), render


def test_a_layer_that_the_file_lacks_is_not_linked(session: Session) -> None:
    (render,) = session.apply(DropFiles([NEON], (0.0, 0.0)))
    assert "occlusion" not in read_render(str(NEON), sandbox=UNRESTRICTED).layers
    session.select([ElementId(render)])
    light = append(session, "deferred_lighting")
    fed = {target.socket for target in session.graph.links if target.node == light}
    assert {"albedo", "normal", "position", "emission"} <= fed and "occlusion" not in fed
    session.select(())
    other = append(session, "deferred_lighting")
    session.apply(ConnectNodes(Port(render, "albedo"), Port(other, "albedo")))
    assert {target.socket for target in session.graph.links if target.node == other} == fed


def test_dropped_files_stand_in_a_column(session: Session, tmp_path: Path) -> None:
    paths = [tmp_path / f"plate_{letter}.exr" for letter in "abcd"]
    ids = session.apply(DropFiles([*paths, *paths], (40.0, 30.0)))
    assert len({session.positions[ElementId(id)][0] for id in ids}) == 1
    assert not find_overlaps(session.graph)
    session.apply(DropFiles(paths, (40.0, 30.0)))
    assert not find_overlaps(session.graph)


def feeders_of(session: Session, id: str) -> dict[str, str]:
    """What feeds each socket of a node."""
    return {target.socket: str(source) for target, source in session.graph.links.items() if target.node == id}


def test_layers_of_a_render_come_from_behind_the_chain(session: Session) -> None:
    session.files.open_pictures([NEON])
    (render,) = session.graph.nodes
    bloom = append(session, "bloom")
    focus = append(session, "depth_of_field")
    assert feeders_of(session, focus) == {"image": f"{bloom}.out", "depth": f"{render}.depth"}
    assert session.graph.links[Port("outputs", "image")] == Port(focus, "out")
    fog = append(session, "fog")
    assert feeders_of(session, fog)["image"] == f"{focus}.out"
    assert {"depth": f"{render}.depth", "camera": f"{render}.camera"}.items() <= feeders_of(session, fog).items()
    assert session.positions[ElementId(fog)][0] > session.positions[ElementId(focus)][0]


def test_a_relight_after_an_occlusion_takes_the_occlusion_and_the_surfaces_behind_it(session: Session) -> None:
    session.files.open_pictures([NEON])
    (render,) = session.graph.nodes
    occlusion = append(session, "ambient_occlusion")
    relight = append(session, "deferred_lighting")
    fed = feeders_of(session, relight)
    assert fed.pop("occlusion") == f"{occlusion}.occlusion"
    assert fed == {name: f"{render}.{name}" for name in ("albedo", "normal", "depth", "position", "camera", "emission")}


def test_no_layer_is_taken_from_behind_a_node_that_moves_pixels(session: Session) -> None:
    session.files.open_pictures([NEON])
    append(session, "transform")
    focus = append(session, "depth_of_field")
    assert feeders_of(session, focus) == {"image": "transform.out"}


def test_inputs_of_the_graph_are_layers_too(session: Session) -> None:
    inputs = {name: Input(kind) for name, kind in (("image", Kind.IMAGE), ("depth", Kind.FIELD), ("matte", Kind.FIELD))}
    graph = Graph(inputs=inputs, outputs={"image": Output(Kind.IMAGE)}).add("bloom", session.types["bloom"]())
    graph = graph.connect(Port("inputs", "image"), Port("bloom", "image"))
    session.apply(ReplaceGraph("Start", graph))
    session.select(ElementId("bloom"))
    assert feeders_of(session, append(session, "depth_of_field")) == {"image": "bloom.out", "depth": "inputs.depth"}
    session.select(ElementId("inputs.depth"))
    alone = append(session, "depth_of_field")
    assert feeders_of(session, alone) == {"depth": "inputs.depth"}, "it feeds no second socket"
    session.select(ElementId("bloom"))
    # a matte is somebody's choice, no fact of the render
    assert "matte" not in feeders_of(session, append(session, "set_matte"))


GOLD = {
    "Combined": (0.4, 0.3, 0.1, 1.0),
    "Diffuse Color": (0.0, 0.0, 0.0),
    "Glossy Color": (1.0, 0.7643, 0.3339),
    "Normal": (0.0, 0.0, 1.0),
    "Depth": (4.0,),
}
"""What Cycles 5.0.1 writes of gold."""


def write_gold(folder: Path, leave_out: str = "") -> Path:
    """A render of nothing but gold."""
    layers = {name: color for name, color in GOLD.items() if name != leave_out}
    letters = {4: "RGBA", 3: "RGB", 1: "Z"}
    names = [
        f"ViewLayer.{name}.{letter}"
        for name, color in layers.items()
        for letter in ("XYZ" if name == "Normal" else letters[len(color)])
    ]
    spec = oiio.ImageSpec(16, 9, len(names), "float")
    spec.channelnames = tuple(names)
    spec.attribute("Software", "Blender 5.0.1")
    path = folder / f"gold_{leave_out or 'all'}.exr"
    file = oiio.ImageOutput.create(str(path))
    assert file is not None and file.open(str(path), spec), oiio.geterror()
    pixels = np.float32([number for color in layers.values() for number in color])
    file.write_image(np.broadcast_to(pixels, (9, 16, len(names))).copy())
    file.close()
    return path


def test_relit_gold_of_blender_is_gold(session: Session, tmp_path: Path, renderer: Renderer) -> None:
    """Its diffuse color is black: the glossy color, which the render has beside it, comes along.

    The render tells no camera, so none is linked.
    """
    session.files.open_pictures([write_gold(tmp_path)])
    (render,) = session.graph.nodes
    relight = append(session, "deferred_lighting")
    fed = feeders_of(session, relight)
    assert fed["normal"] == f"{render}.normal" and "camera" not in fed
    assert (fed["albedo"], fed["material"]) == ("material_from_colors.albedo", "material_from_colors.material")
    assert feeders_of(session, "material_from_colors") == {
        "diffuse_color": f"{render}.albedo",
        "glossy_color": "glossy_color.out",
    }
    assert session.selection == {ElementId(relight)} and not find_overlaps(session.graph)
    lit = renderer.render(session.graph, RenderRequest(targets={"lit": Port(relight, "out")}))["lit"]
    red, green, blue = lit[4, 8, :3]
    assert red > 0.1 and 0.6 * red < green < 0.85 * red and 0.25 * red < blue < 0.45 * red
    session.undo()
    assert list(session.graph.nodes) == [render]


def test_a_second_light_shares_the_material(session: Session, tmp_path: Path) -> None:
    session.files.open_pictures([write_gold(tmp_path)])
    (render,) = session.graph.nodes
    append(session, "deferred_lighting")
    session.select([ElementId(render)])
    other = append(session, "deferred_lighting")
    assert feeders_of(session, other)["material"] == "material_from_colors.material"
    assert len(session.graph.nodes) == 5 and not find_overlaps(session.graph)


def test_no_metal_is_looked_for_where_no_layer_tells_it(session: Session, tmp_path: Path) -> None:
    session.files.open_pictures([write_gold(tmp_path, "Glossy Color")])
    relight = append(session, "deferred_lighting")
    assert len(session.graph.nodes) == 2 and "material" not in feeders_of(session, relight)


def test_room_for_a_node_is_what_the_canvas_draws_and_little_more() -> None:
    """Before a node is drawn its size is guessed: too little would cover others, much too much would push them away."""
    for id in [*catalogue()][::4]:
        graph = Graph().add("n", catalogue()[id]())
        width, height = estimate_sizes(graph)[ElementId("n")]
        drawn = make_node_layout("n", graph.nodes["n"], graph, NodeFacts(picture=True))
        assert 0.0 <= height - drawn.height < 100.0 and abs(width - drawn.width) < 8.0, id
    assert estimate_sizes(graph, {ElementId("n"): (7.0, 9.0)}) == {ElementId("n"): (7.0, 9.0)}

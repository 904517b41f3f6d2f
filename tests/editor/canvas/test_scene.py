"""What is on the canvas and what the mouse hits; no window."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_links import sample_wire
from halation.authoring.edits.decor import add_frame
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_elements
from halation.authoring.edits.layout import pin_places, positions
from halation.editor.canvas.geometry import overlaps
from halation.editor.canvas.gestures import (
    LinkGesture,
    MoveGesture,
    ResizeGesture,
    add_crossing_dots,
    find_fitting_pins,
    find_insertion,
    find_refused_pin,
    find_snap_pin,
    find_touched,
    move_to,
    preview_gesture,
    resize_to,
)
from halation.editor.canvas.layout import HEADER
from halation.editor.canvas.scene import CanvasScene, find_pin
from halation.editor.canvas.staging import SceneBuilder, measure_comment
from halation.editor.shared.entries import GROUP, arrange_entries, graph_entries, keep_fitting, node_entries
from halation.graph import Graph, Input, Output, Port, Unknown
from halation.nodes import catalogue
from random_graphs import random_graph

from gui_canvas import chain  # isort: skip

P = Port.parse


def staged(
    graph: Graph, stage: SceneBuilder | None = None, pictures: frozenset[str] = frozenset(), open: str = ""
) -> CanvasScene:
    return (stage or SceneBuilder()).build(graph, positions(pin_places(graph)).__getitem__, (), pictures, open)


def pin(scene: CanvasScene, port: str, output: bool) -> tuple[float, float]:
    return next((box.x + one.x, box.y + one.y) for name, box, one in scene.list_pins(output) if name == P(port))


def test_hits_pins_fields_titles_and_links() -> None:
    scene = staged(chain("exposure", "bloom"))
    box = scene.boxes["exposure"]
    assert scene.find_hit(*pin(scene, "exposure.out", True), 8.0).port == P("exposure.out")
    assert scene.find_hit(box.x + 60, box.y + 10, 8.0).part == "title"
    field = next(row.field for row in box.layout.rows if row.field)
    hit = scene.find_hit(box.x + field[0] + 40, box.y + field[1] + 5, 8.0)
    assert (hit.part, hit.port) == ("field", P("exposure.stops"))
    wire = scene.by_target[P("bloom.image")]
    assert scene.find_hit(*wire.middle, 8.0).port == P("bloom.image")
    assert scene.find_hit(box.x, box.y - 300, 8.0).part == "empty"


def test_a_link_to_a_pin_that_is_not_shown_meets_the_title() -> None:
    box = staged(chain("exposure", "bloom")).boxes["exposure"]
    assert box.x == box.rect[0] and box.w > 0.0
    assert find_pin(box, "nothing", output=False) == (box.x, box.y + HEADER / 2)
    assert find_pin(box, "nothing", output=True) == (box.x + box.w, box.y + HEADER / 2)


def test_what_is_drawn_last_is_hit_first() -> None:
    graph = chain("exposure", "bloom")
    scene = SceneBuilder().build(graph, lambda key: (0.0, 0.0), ["exposure"])
    assert scene.find_hit(60.0, 12.0, 1.0).key == "exposure"


def test_links_follow_what_moves_and_nothing_else_does() -> None:
    scene = staged(chain("exposure", "bloom"))
    after = scene.move({"bloom"}, 10.0, 20.0)
    start, end = after.by_target[P("bloom.image")].curves[0][:2], after.by_target[P("bloom.image")].curves[0][6:]
    assert start == scene.by_target[P("bloom.image")].curves[0][:2]
    assert end == pin(after, "bloom.image", False)
    assert after.by_target[P("exposure.image")] is scene.by_target[P("exposure.image")]


def test_layouts_are_built_again_only_where_something_changed() -> None:
    stage, graph = SceneBuilder(), chain("exposure", "bloom")
    first = staged(graph, stage)
    second = staged(graph.set(P("exposure.stops"), 2.0), stage)
    assert second.boxes["bloom"].layout is first.boxes["bloom"].layout
    assert second.boxes["exposure"].layout is not first.boxes["exposure"].layout


def test_a_changed_value_leaves_all_boxes_and_links_but_its_own_node() -> None:
    stage, graph = SceneBuilder(), pin_places(chain("exposure", "bloom"))
    first = staged(graph, stage)
    second = staged(graph.set(P("exposure.stops"), 2.0), stage)
    assert second.links is first.links
    assert [key for key, box in second.boxes.items() if box is not first.boxes[key]] == ["exposure"]
    assert second == staged(graph.set(P("exposure.stops"), 2.0))


@pytest.mark.parametrize(
    "change",
    [
        lambda graph: graph.mute("bloom"),
        lambda graph: graph.disconnect(P("bloom.image")),
        lambda graph: graph.replace("bloom", catalogue()["noise"]()),
        lambda graph: graph.add("b", catalogue()["clip"]()),
        lambda graph: graph.add_input("more", Input()),
        lambda graph: graph.rename("bloom", "glow"),
    ],
)
def test_what_is_staged_again_is_what_is_staged_anew(change) -> None:
    stage, graph = SceneBuilder(), pin_places(chain("exposure", "bloom"))
    staged(graph, stage)
    assert staged(pin_places(change(graph)), stage) == staged(pin_places(change(graph)))


def test_a_first_picture_moves_no_pin_and_no_field() -> None:
    graph = chain("exposure", "tone_map")
    before, after = staged(graph), staged(graph, pictures=frozenset({"exposure", "tone_map", "inputs.beauty"}))
    assert before.links.wires == after.links.wires
    for key in ("exposure", "tone_map"):
        old, new = before.boxes[key].layout, after.boxes[key].layout
        assert (new.rows, new.ins, new.outs, new.more) == (old.rows, old.ins, old.outs, old.more)
        assert new.height > old.height + 90.0 and new.picture[3] <= new.height and new.picture[1] >= old.foot
    assert after.boxes["outputs.image"] == before.boxes["outputs.image"]


def test_a_node_shows_few_values_until_asked_for_all_and_linked_ones_always() -> None:
    graph = chain("tone_map").add("mean", catalogue()["luminance_statistics"]())
    graph = graph.connect(P("inputs.beauty"), P("mean.image")).connect(P("mean.maximum"), P("tone_map.maximum"))
    few = staged(graph).boxes["tone_map"].layout
    every = staged(graph, open="tone_map").boxes["tone_map"].layout
    assert few.hidden > 0 and every.hidden == 0 and every.height > few.height
    names = {name for name, value in catalogue()["tone_map"].values.items() if not value.folded}
    assert {row.value.name for row in every.rows if row.value} == names
    linked = {row.value.name for row in few.rows if row.value and row.linked}
    assert linked == {"maximum"}


def test_unknown_nodes_keep_pins_for_their_links() -> None:
    graph = chain("exposure").add("old", Unknown("gone", {}))
    graph = graph.connect(P("exposure.out"), P("old.a")).connect(P("old.b"), P("outputs.image"))
    layout = staged(graph).boxes["old"].layout
    assert set(layout.ins) == {"a"} and set(layout.outs) == {"b"}


def test_a_dragged_link_fits_what_makes_no_loop_and_snaps() -> None:
    graph = chain("exposure", "bloom")
    scene = staged(graph)
    targets = find_fitting_pins(graph, scene, P("bloom.out"), True)
    assert P("outputs.image") in targets and P("exposure.image") not in targets
    link = LinkGesture(P("bloom.out"), True, None, targets)
    x, y = pin(scene, "outputs.image", False)
    assert find_snap_pin(scene, link, (x - 10, y + 5), 20.0)[0] == P("outputs.image")
    assert find_snap_pin(scene, link, (x - 100, y - 200), 20.0) is None
    assert find_refused_pin(scene, link, pin(scene, "exposure.image", False), 8.0) == P("exposure.image")


def test_of_pins_within_reach_the_nearest_says_whether_a_link_fits() -> None:
    graph = chain("exposure").add("merge", catalogue()["merge"]())
    scene = staged(graph)
    link = LinkGesture(P("exposure.out"), True, None, find_fitting_pins(graph, scene, P("exposure.out"), True))
    for socket, refused in (("a", None), ("b", None), ("mask", P("merge.mask"))):  # the mask takes no picture
        assert find_refused_pin(scene, link, pin(scene, f"merge.{socket}", False), 60.0) == refused


def test_a_free_node_on_a_link_can_be_put_into_it() -> None:
    graph = chain("exposure", "bloom").add("clip", catalogue()["clip"]())
    scene = staged(graph)
    box = scene.boxes["clip"]
    x, y = scene.by_target[P("bloom.image")].middle
    there = scene.move({"clip"}, x - box.x - box.w / 2, y - box.y - 24.0)
    assert find_insertion(graph, there, {ElementId("clip")}, (x, y), 9.0) == P("bloom.image")
    assert find_insertion(graph, there, {ElementId("exposure")}, (x, y), 9.0) is None
    assert find_insertion(graph, there, {ElementId("clip"), ElementId("bloom")}, (x, y), 9.0) is None
    pair = graph.add("vignette", catalogue()["vignette"]()).connect(P("clip.out"), P("vignette.image"))
    scene = staged(pair)
    there = scene.move({"clip", "vignette"}, x - scene.boxes["clip"].x - 90.0, y - scene.boxes["clip"].y - 24.0)
    assert find_insertion(pair, there, {ElementId("clip"), ElementId("vignette")}, (x, y), 9.0) == P("bloom.image")
    assert find_insertion(pair, there, {ElementId("clip")}, (x, y), 9.0) is None, "it is linked with what stays"


def test_links_of_one_source_share_the_dot_that_a_line_makes() -> None:
    graph = chain("exposure").add("bloom", catalogue()["bloom"]())
    graph = graph.connect(P("exposure.out"), P("bloom.image"))
    after, keys = add_crossing_dots(graph, {P("bloom.image"): (500.0, 10.0), P("outputs.image"): (500.0, 20.0)})
    assert len(keys) == 1
    assert after.ui["routes"]["bloom.image"] == after.ui["routes"]["outputs.image"]
    wires = staged(after).by_target
    assert wires[P("bloom.image")].stops == ("exposure", keys[0], "bloom")


def test_rectangles_take_what_they_touch_but_frames_only_whole() -> None:
    graph = chain("exposure")
    scene = staged(graph)
    box = scene.boxes["exposure"]
    rect = (box.x - 5, box.y - 5, box.x + 5, box.y + 5)
    assert find_touched(scene, rect) == ("exposure",)
    framed, _ = add_frame(graph, [ElementId("exposure")], positions(graph))
    scene = staged(framed)
    assert find_touched(scene, rect) == ("exposure",)
    assert set(find_touched(scene, (-900.0, -900.0, 2000.0, 900.0))) == set(scene.boxes)


def test_moving_snaps_to_the_grid_and_resizing_keeps_the_other_edges() -> None:
    scene = staged(chain("exposure"))
    move = move_to(
        MoveGesture(ElementId("exposure"), (0.0, 0.0), frozenset({"exposure"})), scene, (5.0, 13.0), snap=True
    )
    box = preview_gesture(scene, move).boxes["exposure"]
    assert box.x % 16 == 0 and box.y % 16 == 0
    before = (0.0, 0.0, 200.0, 100.0)
    assert resize_to(ResizeGesture(ElementId("f"), "r", (200.0, 50.0), before, before), (260.0, 90.0), False).rect == (
        0,
        0,
        260,
        100,
    )
    assert resize_to(ResizeGesture(ElementId("f"), "lt", (0.0, 0.0), before, before), (999.0, 999.0), False).rect == (
        104,
        36,
        200,
        100,
    )


@pytest.mark.parametrize(("query", "first"), [("gaus", "gaussian_blur"), ("edge", "edge_detect"), ("expo", "exposure")])
def test_a_few_letters_find_a_node(query: str, first: str) -> None:
    assert arrange_entries(node_entries(catalogue()), query)[0].entries[0].id == first


def test_without_letters_the_recent_come_first_and_all_are_listed_by_category() -> None:
    entries = (*node_entries(catalogue()), *graph_entries())
    sections = arrange_entries(entries, "", ["bloom", "gone"])
    assert [entry.id for entry in sections[0].entries] == ["bloom"]
    assert sum(len(section.entries) for section in sections[1:]) == len(entries)
    assert GROUP not in {section.title for section in sections}
    assert [entry.id for entry in keep_fitting(entries, ["bloom", "clip"])] == ["clip", "bloom"]


def test_words_of_the_description_find_too() -> None:
    entries = node_entries(catalogue())
    assert "exposure" in {entry.id for entry in arrange_entries(entries, "stops")[0].entries}


def test_ends_and_outputs_are_boxes_with_one_pin() -> None:
    graph = Graph().add_input("a", Input()).add_output("b", Output()).connect(P("inputs.a"), P("outputs.b"))
    scene = staged(graph)
    assert [str(port) for port, _, _ in scene.list_pins(True)] == ["inputs.a"]
    assert [str(port) for port, _, _ in scene.list_pins(False)] == ["outputs.b"]


def test_comments_are_as_high_as_their_text() -> None:
    short, long = (measure_comment(text, 200.0) for text in ("a note", "many words " * 20))
    assert short == 40.0 and long > 120.0
    assert measure_comment("one\n\ntwo", 200.0) > measure_comment("one", 200.0)
    assert measure_comment("many words " * 20, 400.0) < long


def test_the_mask_takes_no_row_until_its_values_are_set() -> None:
    layout = staged(chain("exposure")).boxes["exposure"].layout
    assert layout.ins["mask"].y < layout.rows[0].y and "mask" not in {row.left.name for row in layout.rows if row.left}
    assert not {"mix", "invert_mask"} & {row.value.name for row in layout.rows if row.value}
    mixed = staged(chain("exposure").set(P("exposure.mix"), 0.5), open="exposure").boxes["exposure"].layout
    assert "mix" in {row.value.name for row in mixed.rows if row.value}


@pytest.mark.parametrize("seed", range(6))
def test_a_picture_that_comes_or_goes_changes_only_its_element(seed: int) -> None:
    graph, rng = random_graph(seed, 12), np.random.default_rng(seed)
    keys, builder = list_elements(graph), SceneBuilder()
    before = staged(graph, builder)
    for _ in range(5):
        pictures = frozenset(key for key in keys if rng.random() < 0.5)
        scene = staged(graph, builder, pictures)
        assert scene.boxes == staged(graph, None, pictures).boxes
        assert scene.wires == staged(graph, None, pictures).wires
        assert scene.links is before.links, "links are not routed again"


@pytest.mark.parametrize("seed", range(6))
def test_what_is_in_view_is_what_a_dense_sample_finds(seed: int) -> None:
    scene, rng = staged(random_graph(seed, 12)), np.random.default_rng(seed)
    for _ in range(20):
        x, y = rng.uniform(-200, 1500, 2)
        rect = (x, y, x + rng.uniform(20, 800), y + rng.uniform(20, 800))
        found = {wire.target for wire in scene.links.list_visible(rect)}
        sampled = {
            wire.target
            for wire in scene.wires
            for points in [sample_wire(wire)]
            if ((points >= rect[:2]).all(1) & (points <= rect[2:]).all(1)).any()
        }
        assert sampled <= found
        assert scene.list_boxes(rect) == [box for box in scene.boxes.values() if overlaps(box.rect, rect)]


def test_scenes_without_links_show_none() -> None:
    assert staged(Graph()).links.list_visible((0.0, 0.0, 9.0, 9.0)) == []
    assert staged(Graph()).bounds is None

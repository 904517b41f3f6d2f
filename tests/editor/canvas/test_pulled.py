"""What is grabbed follows the pointer: handles on the picture, nodes, links, keys and the current frame.

Where something goes is measured on the screen after the button is released, and compared with how far the mouse has
moved; nothing here knows how pixels become values.
"""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from halation.authoring.commands import AnimateValues, ArrangeElements, SetFrameRange
from halation.errors import GraphError
from halation.graph import Graph, Key, Keys, Output, Port
from halation.nodes import Kind, catalogue
from still_editor import StillEditor, open_still_editor
from still_pictures import HANDLED, make_graph

FREE = ("center", "move", "pivot", "focus_point", "anchor", "shadow_offset", "top_right", "bottom_left", "points")
"""How the places of handles end that go wherever the pointer goes."""

LIMITED = "crop", "corner_pin", "lens_distortion", "feedback", "deferred_lighting"
"""Nodes some of whose handles are at the end of their way, or snap to the border, or wait for a surface."""

SIZE = 900.0, 700.0


def middle(box: tuple[float, float, float, float]) -> tuple[float, float]:
    return (box[0] + box[2]) / 2, (box[1] + box[3]) / 2


def measure_way(still: StillEditor, title: str, place: str, by: tuple[float, float]) -> tuple[float, float]:
    """How far something has moved with the pointer."""
    x, y = middle(still.places[place])
    still.pull(title, place, by)
    ends = middle(still.places[place])
    return ends[0] - x, ends[1] - y


def arrange(still: StillEditor) -> None:
    """No element lies over another one."""
    still.show("Graph", 4)
    canvas = still.editor.canvas
    still.editor.session.apply(ArrangeElements(canvas.sizes or {}, canvas.find_pins()))
    canvas.fit()
    still.show("Graph", 4)


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("id", [id for id in HANDLED if id not in ("paint", "deferred_lighting")])
def test_a_handle_goes_where_the_pointer_goes(tmp_path: Path, id: str, scale: float) -> None:
    """A free one as far as the pointer, one that is an edge along its axis, any other at least in its direction."""
    by = 24.0 * scale, 14.0 * scale
    with open_still_editor(tmp_path, make_graph(id), scale=scale, size=SIZE) as still:
        session = still.editor.session
        still.select("node")
        session.views.show(Port("node", next(iter(catalogue()[id].outputs))))
        still.show("Viewer", 2)
        still.compute()
        still.show("Viewer")
        root, handles = session.root, [place for place in still.places if place.startswith(("handle ", "point "))]
        assert handles
        for place in handles:
            across, down = measure_way(still, "Viewer", place, by)
            is_moved = math.hypot(across, down) > 1.0
            assert is_moved or id in LIMITED or session.root is root, place
            if is_moved and place.endswith(FREE):
                assert (across, down) == pytest.approx(by, abs=0.2 * scale), place
            elif is_moved:
                assert across * by[0] + down * by[1] > 0.0, place
                assert math.hypot(across, down) < 1.5 * math.hypot(*by), place
            still.undo_to(root)
            still.calm("Viewer")
            still.select("node")
            still.show("Viewer", 3)


@pytest.mark.parametrize("zoom", [0.4, 0.6])
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_node_goes_where_the_pointer_goes_and_the_others_stay(tmp_path: Path, zoom: float, scale: float) -> None:
    by = 96.0 * scale, 64.0 * scale
    graph = make_graph("bloom").add_output("image", Output(Kind.IMAGE, 4))
    graph = graph.connect(Port("node", "out"), Port("outputs", "image"))
    with open_still_editor(tmp_path, graph, scale=scale, size=SIZE) as still:
        arrange(still)
        still.editor.canvas.zoom = zoom
        still.show("Graph")
        root, titles = still.editor.session.root, [place for place in still.places if place.startswith("title ")]
        for place in titles:
            before = {name: middle(still.places[name]) for name in titles if name in still.places}
            if place not in before:
                continue
            way = measure_way(still, "Graph", place, by)
            assert way == pytest.approx(by, abs=17.0 * scale), "it may snap to a line that is near"
            others = {name: middle(still.places[name]) for name in before if name in still.places}
            assert all(others[name] == pytest.approx(before[name], abs=0.6) for name in others if name != place)
            assert still.editor.session.selection == {place.removeprefix("title ")}
            still.undo_to(root)
            still.calm("Graph")
            still.show("Graph", 3)


@pytest.mark.parametrize("backwards", [False, True])
def test_a_link_is_drawn_from_pin_to_pin_wherever_the_graph_allows_it(tmp_path: Path, backwards: bool) -> None:
    graph = make_graph("bloom").add_output("image", Output(Kind.IMAGE, 4)).add_output("mask", Output(Kind.FIELD, 1))
    with open_still_editor(tmp_path, graph, size=SIZE) as still:
        session = still.editor.session
        arrange(still)
        root, tried = session.root, [0, 0]
        sources = [place for place in still.places if place.startswith("pin out ")]
        targets = [place for place in still.places if place.startswith("pin in ")]
        for source in sources:
            for target in targets:
                one, other = Port.parse(source.removeprefix("pin out ")), Port.parse(target.removeprefix("pin in "))
                try:
                    wanted = root.connect(one, other).links
                except GraphError:
                    wanted = None
                start, end = (target, source) if backwards else (source, target)
                if start not in still.places or end not in still.places or (backwards and other in root.links):
                    continue  # a linked input gives its link away
                (x0, y0), (x1, y1) = middle(still.places[start]), middle(still.places[end])
                still.pull("Graph", start, (x1 - x0, y1 - y0))
                links = session.root.links
                assert links == (wanted if wanted is not None else root.links), (source, target)
                tried[wanted is not None] += 1
                still.undo_to(root)
                still.calm("Graph")
                still.show("Graph", 2)
        assert min(tried) > 3


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_keys_and_the_current_frame_follow_the_pointer(tmp_path: Path, scale: float) -> None:
    with open_still_editor(tmp_path, Graph().add("glow", catalogue()["bloom"]()), scale=scale, size=SIZE) as still:
        session = still.editor.session
        moves = {Port("glow", "intensity"): Keys((Key(1, 0.2), Key(12, 0.9), Key(24, 0.5))),
                 Port("glow", "knee"): Keys((Key(5, 0.2), Key(20, 1.0)))}  # fmt: skip
        session.apply(SetFrameRange(1, 48))
        session.apply(AnimateValues(moves, "Animate"))
        still.select("glow")
        still.show("Animation", 4)
        root = session.root
        one, other = (middle(still.places[f"key glow.knee {at}"])[0] for at in (5, 20))
        step = (other - one) / 15
        for port, animation in moves.items():
            for key in animation.keys:
                for frames in (7, -3):
                    place = f"key {port} {key.frame:g}"
                    at = middle(still.places[place])
                    still.pull("Animation", place, (frames * step, 0.0))
                    after = session.root.animation[port]
                    assert isinstance(after, Keys)
                    wanted = sorted([each.frame for each in animation.keys if each is not key] + [key.frame + frames])
                    assert sorted({each.frame for each in after.keys}) == sorted({*wanted}), (place, frames)
                    moved = still.places.get(f"key {port} {key.frame + frames:g}")
                    assert moved is None or middle(moved) == pytest.approx((at[0] + frames * step, at[1]), abs=1.5)
                    still.undo_to(root)
                    still.calm("Animation")
                    still.show("Animation", 3)
        for title, place, width in (("Animation", "keys now", step), ("Timeline", "ruler now", None)):
            session.time.seek(10)
            still.show(title, 3)
            if width is None:
                first, last = (middle(still.places[f"ruler {end}"])[0] for end in (1, 48))
                width = (last - first) / 47
            way = measure_way(still, title, place, (9.0 * width, 0.0))
            assert session.time.frame == 19 and way == pytest.approx((9.0 * width, 0.0), abs=1.5)

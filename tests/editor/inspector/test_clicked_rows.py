"""Rows of the inspector: where they are, and that clicks and drags in them do the same on an interface twice the size.

What an act does is read off the document, and compared between two windows: nothing here knows what it should be, only
that a field's part is a part of it, whatever its place and size are.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from halation import document
from halation.graph import Graph, Output, Port
from halation.nodes import Kind, catalogue
from imgui_bundle import imgui
from still_editor import StillEditor, is_alike, open_still_editor
from toy_nodes import Tint

ACTED_ON = ("field ", "name ", "button ", "chip ", "fold ", "key ")


def make_graph() -> Graph:
    types = catalogue()
    graph = Graph().add_output("image", Output(Kind.IMAGE, 4)).add("tint", Tint())
    for id in ("noise", "grade", "tone_map", "vignette"):
        graph = graph.add(id, types[id]())
    for source, target in (("grade.out", "tone_map.image"), ("tone_map.out", "outputs.image"),
                           ("noise.value", "tone_map.average"), ("noise.out", "grade.image")):  # fmt: skip
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


def describe(still: StillEditor) -> dict[str, object]:
    """What an act may have changed."""
    editor, session = still.editor, still.editor.session
    menu = [shape.text for shape in still.pane.widgets if shape.kind in ("menu_item", "selectable", "begin_menu")]
    dialogs = editor.dialogs.browse is not None, sorted(editor.dialogs.open), editor.viewer.picking
    return {
        "document": json.loads(document.dumps(session.root)),
        "selected": sorted(session.selection),
        "menu": menu,
        "dialogs": dialogs,
        "places": sorted(editor.places),
    }


def act_on_all(still: StillEditor, name: str) -> Iterator[tuple[str, dict[str, object]]]:
    """Click, drag and open the menu of all that is shown of an element, each on the same document."""
    session, start = still.editor.session, still.editor.session.root
    still.select(name)
    still.show("Inspector")
    for place in sorted(place for place in still.places if place.startswith(ACTED_ON)):
        for act in ("click", "drag", "menu", "wheel"):
            if place not in still.places or (act in ("drag", "wheel") and not place.startswith("field ")):
                continue
            if act == "drag":
                still.drag("Inspector", place, (0.5, 0.5), (0.75, 0.25))
            elif act == "wheel":
                still.turn_wheel("Inspector", place, 1.0)
            else:
                still.click("Inspector", place, int(act == "menu"), (0.3, 0.4))
            yield f"{name}: {act} {place}", describe(still)
            still.calm("Inspector")
            while session.root is not start and session.history.steps:
                session.undo()
            still.editor.dialogs.close()
            still.editor.viewer.picking = ""
            still.select(name)
            still.show("Inspector", 2)


@pytest.mark.parametrize("name", ["tone_map", "vignette", "tint", "outputs.image"])
def test_acts_do_the_same_on_a_larger_interface(tmp_path: Path, name: str) -> None:
    answers = []
    for number, (scale, at) in enumerate(((1.0, (20.0, 30.0)), (2.0, (300.0, 40.0)))):
        with open_still_editor(tmp_path / str(number), make_graph(), scale=scale, at=at) as still:
            answers.append(dict(act_on_all(still, name)))
    small, large = answers
    assert small.keys() == large.keys()
    changed = {json.dumps(entry["document"]) for entry in small.values()}
    assert len(changed) > 2, "some acts change the document"
    wrong = {act: key for act, entry in small.items() for key in entry if not is_alike(entry[key], large[act][key])}
    assert not wrong


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_names_and_fields_have_a_column_each(tmp_path: Path, scale: float) -> None:
    """Names end left of the diamond of keys, fields begin behind it and end at the border of the panel."""
    with open_still_editor(tmp_path, make_graph(), scale=scale) as still:
        for node in ("noise", "tone_map", "vignette"):
            still.select(node)
            still.show("Inspector")
            names = {key: rect for key, rect in still.places.items() if key.startswith(f"name {node}.")}
            longest = max(imgui_width(still, key.partition(".")[2].replace("_", " ")) for key in names)
            column = min(max(0.3 * 324.0 * scale, longest + 25.0 * scale + 1.0), 0.48 * 324.0 * scale, 210.0 * scale)
            tops = list[float]()
            for key, (left, top, right, bottom) in names.items():
                assert left == 28.0 * scale and bottom - top == 24.0 * scale
                spare = 16.0 if key.partition(".")[2] in catalogue()[node].values else 0.0
                assert right == pytest.approx((28.0 - spare) * scale + column, abs=1.0)
                if field := still.places.get(key.replace("name", "field", 1)):
                    assert field[0] == pytest.approx((28.0 + 6.0) * scale + column, abs=1.5)
                    assert abs(field[1] - top) <= 4.0 * scale, "a note on a line of text has no frame"
                    assert not spare or field[2] in (
                        pytest.approx(352.0 * scale, abs=1.0),
                        pytest.approx(328.0 * scale, abs=1.0),
                    )
                tops.append(top)
            steps = [round(after - before) for before, after in pairwise(tops)]
            assert min(steps) == 30 * scale, "a field is 24 high, and 6 are between two"


def imgui_width(still: StillEditor, text: str) -> float:
    return still.pane.draw(lambda: imgui.calc_text_size(text).x)


@pytest.mark.parametrize(("layer", "shown"), [("", False), ("Normals", True)])
def test_a_layer_that_was_chosen_is_shown_before_the_file_is_there(tmp_path: Path, layer: str, shown: bool) -> None:
    node = catalogue()["read_render"](normal_layer=layer)
    with open_still_editor(tmp_path, Graph().add("render", node)) as still:
        still.select("render")
        still.show("Inspector")
        assert ("field render.normal_layer" in still.places) is shown
        assert "field render.depth_layer" not in still.places, "it lies in the folded section"
        still.click("Inspector", "more render layers", part=(0.1, 0.5))
        assert {"field render.normal_layer", "field render.depth_layer"} <= still.places.keys()

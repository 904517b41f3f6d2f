"""What the entries in the menu of a value do to the document, and what the tips of its name and its button say.

The menu is opened with the right button on a name or a field; what each entry must do follows from its words.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from halation.authoring.commands import SetFrameRange, SetValue
from halation.graph import Graph, Keys, Output, Port
from halation.nodes import Kind, catalogue
from still_editor import StillEditor, open_still_editor
from still_pictures import make_graph as make_linked_graph
from still_screens import list_typical_nodes

INTENSITY, AMOUNT = Port("bloom", "intensity"), Port("vignette", "amount")


def make_graph() -> Graph:
    graph = Graph().add_output("image", Output(Kind.IMAGE, 4))
    for id in ("noise", "bloom", "vignette"):
        graph = graph.add(id, catalogue()[id]())
    for source, target in (("noise.out", "bloom.image"), ("noise.value", "vignette.amount"),
                           ("bloom.out", "vignette.image"), ("vignette.out", "outputs.image")):  # fmt: skip
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


def open_menu(still: StillEditor, place: str) -> dict[str, tuple[float, float, float, float]]:
    """The entries that can be chosen in the menu of a place, and where they are."""
    still.click("Inspector", place, 1, (0.3, 0.4))
    return {
        shape.text.split("##")[0].split("  ")[-1]: (*shape.points[0], *shape.points[1])
        for shape in still.pane.widgets
        if shape.kind == "menu_item"
    }


def choose(still: StillEditor, place: str, entry: str) -> None:
    box = open_menu(still, place)[entry]
    still.pane.click(box, still.find("Inspector").draw)
    still.calm("Inspector")


@pytest.fixture
def still(tmp_path: Path):
    with open_still_editor(tmp_path, make_graph(), size=(500.0, 900.0)) as opened:
        session = opened.editor.session
        session.apply(SetFrameRange(1, 48))
        session.apply(SetValue(INTENSITY, 0.9))
        session.time.seek(7)
        opened.select("bloom")
        opened.show("Inspector")
        yield opened


@pytest.mark.parametrize("place", ["name bloom.intensity", "field bloom.intensity", "diamond bloom.intensity"])
def test_entries_do_what_they_say(still: StillEditor, place: str) -> None:
    session = still.editor.session
    start = session.root
    choose(still, place, "Reset")
    assert session.root.value(INTENSITY) == catalogue()["bloom"].values["intensity"].default
    session.undo()
    choose(still, place, "Set Key")
    keys = session.root.animation[INTENSITY]
    assert isinstance(keys, Keys) and [(key.frame, key.value) for key in keys.keys] == [(7, 0.9)]
    session.time.seek(9)
    still.show("Inspector", 2)
    choose(still, place, "Set Key")
    choose(still, place, "Previous Key")
    assert session.time.frame == 7
    choose(still, place, "Next Key")
    assert session.time.frame == 9
    choose(still, place, "Remove Key")
    keys = session.root.animation[INTENSITY]
    assert isinstance(keys, Keys) and [key.frame for key in keys.keys] == [7]
    choose(still, place, "Remove All Keys")
    assert INTENSITY not in session.root.animation
    still.undo_to(start)
    choose(still, place, "Expose as Control")
    assert [control.target for control in session.root.controls.values()] == [INTENSITY]


def test_a_value_is_copied_to_another_one(still: StillEditor) -> None:
    session = still.editor.session
    choose(still, "name bloom.intensity", "Copy Value")
    choose(still, "name bloom.scatter", "Paste Value")
    assert session.root.value(Port("bloom", "scatter")) == 0.9 == session.root.value(INTENSITY)


def test_a_linked_value_has_its_source_in_place_of_keys(still: StillEditor) -> None:
    session = still.editor.session
    assert not {"Go to Source", "Unlink"} & {*open_menu(still, "name bloom.intensity")}
    still.calm("Inspector")
    still.select("vignette")
    still.show("Inspector", 2)
    entries = open_menu(still, "name vignette.amount")
    still.calm("Inspector")
    assert {"Go to Source", "Unlink"} <= {*entries} and "Set Key" not in entries
    choose(still, "name vignette.amount", "Go to Source")
    assert session.active == "noise"
    still.select("vignette")
    still.show("Inspector", 2)
    choose(still, "name vignette.amount", "Unlink")
    assert AMOUNT not in session.root.links


def test_chips_go_to_the_source_and_crosses_unlink(still: StillEditor) -> None:
    session = still.editor.session
    for target, source in (("vignette.amount", "noise"), ("bloom.image", "noise"), ("vignette.image", "bloom")):
        name = target.partition(".")[0]
        still.select(name)
        still.show("Inspector", 2)
        still.click("Inspector", f"chip {target}")
        assert session.active == source and Port.parse(target) in session.root.links
        still.select(name)
        still.show("Inspector", 2)
        still.click("Inspector", f"button unlink {target}")
        assert Port.parse(target) not in session.root.links and session.selection == {name}


@pytest.mark.parametrize("id", [node.id for node in list_typical_nodes()])
def test_the_tip_of_a_name_is_what_the_node_declares(tmp_path: Path, id: str) -> None:
    node = catalogue()[id]
    with open_still_editor(tmp_path, make_linked_graph(id), size=(500.0, 2000.0)) as still:
        still.select("node")
        still.show("Inspector", 3)
        names = [place for place in still.places if place.startswith("name node.")]
        for place in names:
            name = place.partition(".")[2]
            doc = node.values[name].doc if name in node.values else node.inputs[name].doc if name in node.inputs else ""
            x, y = still.find_point(place, (0.2, 0.5))
            still.pane.point((x, y))
            still.show("Inspector", 2)
            still.pane.point((x + 0.5, y))
            for _ in range(40):
                still.show("Inspector", 1)
            tips = [shape.text for shape in still.pane.widgets if shape.kind == "text_unformatted"]
            assert any(doc in tip for tip in tips), place
            still.pane.point((1.0, 1.0))
            still.show("Inspector", 2)


@pytest.mark.parametrize("places", [("node.center", "radial_blur"), ("node.anchor", "text")])
def test_a_place_is_picked_until_the_switch_is_clicked_again(tmp_path: Path, places: tuple[str, str]) -> None:
    key, id = places
    with open_still_editor(tmp_path, make_linked_graph(id), size=(500.0, 1200.0)) as still:
        still.select("node")
        still.show("Inspector", 3)
        still.click("Inspector", f"button place {key}")
        assert still.editor.viewer.picking == key
        still.calm("Inspector")
        still.editor.viewer.picking = key
        still.click("Inspector", f"button place {key}")
        assert still.editor.viewer.picking == ""

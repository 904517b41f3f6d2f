"""Links made, refused, moved and cut with the mouse."""

from __future__ import annotations

import dataclasses

from gui_canvas import chain, empty, show
from halation.authoring.commands import AddNode
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.elements import list_decor, with_places
from halation.graph import Group, Port
from halation.nodes import catalogue


def with_node(graph, id: str, at: tuple[float, float]):
    """One more node that nothing is linked to."""
    return with_places(graph.add(id, catalogue()[id]()), {ElementId(id): at})


def test_drags_a_link_from_output_to_input(gui) -> None:
    def body(ui) -> None:
        show(ui, with_node(chain("exposure"), "vignette", (640.0, 200.0)))
        ui.drag("pin out exposure.out", "pin in vignette.image")
        assert ui.session.graph.links[Port("vignette", "image")] == Port("exposure", "out")

    gui(body)


def test_drags_a_link_backwards(gui) -> None:
    def body(ui) -> None:
        show(ui, with_node(chain("exposure"), "vignette", (640.0, 200.0)))
        ui.drag("pin in vignette.image", "pin out exposure.out")
        assert ui.session.graph.links[Port("vignette", "image")] == Port("exposure", "out")

    gui(body)


def test_a_link_that_does_not_fit_is_refused_with_a_reason(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        before = ui.session.graph
        ui.drag("pin out bloom.out", "pin in exposure.image", release=False)
        ui.wait(2)
        assert "loop" in ui.editor.canvas.refusal
        ui.shot("canvas_refused.png")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert ui.session.graph is before
        ui.session.apply(AddNode("merge", (900.0, 300.0)))  # a socket that fits is as near as a row: it stays as it is
        ui.editor.canvas.fit()
        ui.settled()
        before = ui.session.graph
        ui.drag("pin out bloom.out", "pin in merge.mask")
        assert ui.session.graph is before and "search bloom" not in ui.editor.places

    gui(body)


def test_a_link_dropped_on_nothing_offers_what_fits_and_links_it(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.drag("pin out inputs.beauty", empty(ui))
        ui.wait(3)
        assert "search read image" not in ui.editor.places, "nothing without inputs fits"
        ui.ctx.key_chars("bloom")
        ui.wait(3)
        ui.keys("Enter")
        ui.wait(3)
        assert ui.session.graph.links[Port("bloom", "image")] == Port("inputs", "beauty")

    gui(body)


def test_a_link_dropped_on_a_node_takes_its_first_fitting_socket(gui) -> None:
    def body(ui) -> None:
        show(ui, with_node(chain("exposure"), "merge", (640.0, 160.0)))
        ui.drag("pin out exposure.out", ui.at("node merge", (0.6, 0.8)))
        assert ui.session.graph.links[Port("merge", "a")] == Port("exposure", "out")

    gui(body)


def test_an_input_hands_its_link_over(gui) -> None:
    def body(ui) -> None:
        show(ui, with_node(chain("exposure", "bloom"), "vignette", (640.0, 260.0)))
        ui.drag("pin in bloom.image", "pin in vignette.image")
        links = ui.session.graph.links
        assert links[Port("vignette", "image")] == Port("exposure", "out")
        assert Port("bloom", "image") not in links
        ui.drag("pin in vignette.image", empty(ui))
        assert Port("vignette", "image") not in ui.session.graph.links

    gui(body)


def test_a_node_dropped_on_a_link_is_inserted_in_one_step(gui) -> None:
    def body(ui) -> None:
        show(ui, with_node(chain("exposure", "bloom"), "vignette", (480.0, 260.0)))
        steps = ui.session.history.position
        start, link = ui.at("title vignette", (0.5, 0.5)), ui.at("link bloom.image")
        ui.drag(start, link)
        links = ui.session.graph.links
        assert links[Port("vignette", "image")] == Port("exposure", "out")
        assert links[Port("bloom", "image")] == Port("vignette", "out")
        assert ui.session.history.position == steps + 1

    gui(body)


def test_cuts_links_by_drawing_across_them(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        x, y = ui.at("link bloom.image")
        ui.drag((x, y - 60), (x, y + 60), button=1, keys="Ctrl")
        assert Port("bloom", "image") not in ui.session.graph.links
        ui.editor.canvas.tool = "cut"
        x, y = ui.at("link exposure.image")
        ui.drag((x, y - 60), (x, y + 60))
        assert Port("exposure", "image") not in ui.session.graph.links
        assert ui.editor.canvas.tool == ""

    gui(body)


def test_puts_dots_on_links_which_then_move_alone(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        x, y = ui.at("link bloom.image")
        ui.drag((x, y - 60), (x, y + 60), button=1, keys="Shift")
        (dot,) = list_decor(ui.session.graph, "dot")
        assert list(ui.session.graph.ui["routes"]["bloom.image"]) == [dot.name]
        before = ui.session.position(dot)
        x, y = ui.at(f"node {dot}")
        ui.drag((x, y), (x, y + 50))
        assert ui.session.position(dot)[1] > before[1] + 30
        assert ui.session.position(ElementId("bloom")) == (640.0, 0.0)

    gui(body)


def test_a_faulty_link_and_an_unlinked_node_are_marked(gui) -> None:
    def body(ui) -> None:
        graph = chain("exposure", "bloom")
        graph = dataclasses.replace(graph, links={**graph.links, Port("exposure", "image"): Port("bloom", "nothing")})
        show(ui, graph)
        ui.shot("canvas_faulty.png")
        assert ui.session.problems["exposure"]
        assert "link exposure.image" in ui.editor.places

    gui(body)


def test_presets_that_fit_are_offered_as_groups_and_linked(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.drag("pin out inputs.beauty", empty(ui))
        ui.until(lambda: "search field" in ui.editor.places)
        ui.ctx.key_chars("neon")
        ui.until(lambda: "search neon edges" in ui.editor.places)
        ui.shot("canvas_search_presets.png")
        ui.keys("Enter")
        ui.until(lambda: "neon_edges" in ui.session.graph.nodes)
        assert isinstance(ui.session.graph.nodes["neon_edges"], Group)
        assert Port("inputs", "beauty") in [
            source for target, source in ui.session.graph.links.items() if target.node == "neon_edges"
        ]

    gui(body)


def test_a_chain_dropped_on_a_link_is_inserted_and_what_follows_makes_room(gui) -> None:
    def body(ui) -> None:
        graph = with_node(with_node(chain("exposure", "bloom"), "vignette", (400.0, 200.0)), "clip", (640.0, 200.0))
        show(ui, graph.connect(Port("vignette", "out"), Port("clip", "image")), 0.6)
        session, steps = ui.session, ui.session.history.position
        before = dict(session.positions)
        session.select((ElementId("vignette"), ElementId("clip")))
        ui.wait(3)
        ui.drag(ui.at("title vignette", (0.5, 0.5)), "link bloom.image", release=False)
        ui.wait(2)
        ui.shot("canvas_chain_over_link.png")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        links = session.graph.links
        assert links[Port("vignette", "image")] == Port("exposure", "out")
        assert links[Port("bloom", "image")] == Port("clip", "out")
        assert session.history.position == steps + 1
        right = session.positions["clip"][0] + ui.editor.canvas.sizes["clip"][0]
        assert session.positions["bloom"][0] > right
        assert session.positions["outputs.image"][0] > before["outputs.image"][0]
        assert session.positions["exposure"] == before["exposure"]
        ui.keys("Ctrl+Z")
        assert dict(session.positions) == before

    gui(body)


def test_alt_takes_a_node_out_of_its_chain_while_it_is_dragged(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        session, before, steps = ui.session, ui.session.graph, ui.session.history.position
        x, y = ui.at("title bloom", (0.3, 0.5))
        ui.drag((x, y), (x, y + 150), keys="Alt", release=False)
        assert session.graph.links[Port("outputs", "image")] == Port("exposure", "out")
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert session.graph == before and session.history.position == steps and not session.history.can_redo
        ui.drag((x, y), (x, y + 150), keys="Alt")
        assert Port("bloom", "image") not in session.graph.links
        assert session.position(ElementId("bloom"))[1] > 100 and session.history.position == steps + 1
        ui.keys("Ctrl+Z")
        assert session.graph == before

    gui(body)


def test_copies_and_pastes_between_places(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        session = ui.session
        ui.click("title exposure", fraction=(0.3, 0.5))
        ui.click("title bloom", fraction=(0.3, 0.5), keys="Shift")
        ui.keys("Ctrl+C")
        ui.move(empty(ui))
        ui.wait(2)
        ui.keys("Ctrl+V")
        ui.until(lambda: len(session.graph.nodes) == 4)
        first, second = sorted(session.selection)
        assert Port(first, "image") in session.graph.links or Port(second, "image") in session.graph.links
        assert session.selection.isdisjoint({"exposure", "bloom"})
        at = ui.editor.canvas.pointer
        left = min(session.position(key)[0] for key in session.selection)
        assert abs(left - at[0]) < 2

    gui(body)


def test_a_node_is_replaced_and_keeps_its_links(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        links = dict(ui.session.graph.links)
        ui.click("title exposure")
        ui.keys("Shift+S")
        ui.until(lambda: "search field" in ui.editor.places)
        ui.ctx.key_chars("saturation")
        ui.wait(3)
        ui.keys("Enter")
        ui.until(lambda: ui.session.graph.nodes["exposure"].id == "saturation")
        assert dict(ui.session.graph.links) == links
        ui.keys("Ctrl+Z")
        ui.until(lambda: ui.session.graph.nodes["exposure"].id == "exposure")

    gui(body)

"""Links made, refused, moved and cut with the mouse."""

from __future__ import annotations

import dataclasses

from gui_canvas import chain, empty, show
from halation.app.editor.edits.elements import with_places
from halation.app.graph import Port
from halation.nodes import catalogue


def with_node(graph, id: str, at: tuple[float, float]):
    """One more node that nothing is linked to."""
    return with_places(graph.add(id, catalogue()[id]()), {id: at})


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
        (dot,) = ui.session.graph.ui["dots"]
        assert list(ui.session.graph.ui["routes"]["bloom.image"]) == [dot]
        before = ui.session.position(f"dots.{dot}")
        x, y = ui.at(f"node dots.{dot}")
        ui.drag((x, y), (x, y + 50))
        assert ui.session.position(f"dots.{dot}")[1] > before[1] + 30
        assert ui.session.position("bloom") == (640.0, 0.0)

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

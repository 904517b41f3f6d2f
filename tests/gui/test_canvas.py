"""What the mouse does on the canvas: selecting, moving, adding, viewing."""

from __future__ import annotations

from gui_canvas import chain, empty, show
from halation.authoring.commands import AddComment, AddFrame, DropFiles, MakeGroup, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.graph import Port


def test_adds_a_node_by_searching(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.move(empty(ui))
        ui.wait(2)
        ui.keys("Tab")
        ui.wait(4)
        at = ui.editor.canvas.pointer
        ui.ctx.key_chars("gaus")
        ui.wait(3)
        ui.shot("canvas_search.png")
        ui.keys("Enter")
        ui.wait(3)
        assert "gaussian_blur" in ui.session.graph.nodes
        assert ui.session.selection == {"gaussian_blur"}
        x, y = ui.session.position(ElementId("gaussian_blur"))
        assert abs(x - at[0]) < 2 and abs(y - at[1]) < 2

    gui(body)


def test_searching_with_the_mouse_and_leaving_it(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.click(empty(ui), button=1)
        ui.click("menu search")
        ui.wait(3)
        ui.ctx.key_chars("vign")
        ui.wait(3)
        ui.click("search vignette")
        assert "vignette" in ui.session.graph.nodes
        before = ui.session.graph
        ui.move(empty(ui))
        ui.wait(2)
        ui.keys("Tab")
        ui.wait(3)
        ui.keys("Escape")
        ui.wait(3)
        assert "search field" not in ui.editor.places
        assert ui.session.graph is before

    gui(body)


def test_selects_by_click_and_by_rectangle(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip"))
        ui.click("title exposure", fraction=(0.2, 0.5))
        assert ui.session.selection == {"exposure"}
        ui.click("title clip", fraction=(0.2, 0.5), keys="Shift")
        assert ui.session.selection == {"exposure", "clip"}
        left, top = ui.at("node exposure", (0.0, 0.0))
        right, bottom = ui.at("node bloom", (1.0, 1.0))
        ui.drag((left - 30, top - 30), (right + 20, bottom + 20))
        assert ui.session.selection == {"exposure", "bloom"}
        ui.click((left, top - 60))
        assert ui.session.selection == frozenset()

    gui(body)


def test_moving_is_one_step_that_undo_takes_back(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        before, steps = ui.session.position(ElementId("bloom")), ui.session.history.position
        x, y = ui.at("title bloom", (0.2, 0.5))
        ui.drag((x, y), (x + 80, y + 120))
        after = ui.session.position(ElementId("bloom"))
        scale = ui.editor.canvas.zoom
        assert abs(after[0] - before[0] - 80 / scale) < 2 and abs(after[1] - before[1] - 120 / scale) < 2
        assert ui.session.history.position == steps + 1
        ui.keys("Ctrl+Z")
        assert ui.session.position(ElementId("bloom")) == before

    gui(body)


def test_escape_cancels_a_move(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        before = ui.session.graph
        x, y = ui.at("title bloom", (0.2, 0.5))
        ui.drag((x, y), (x + 80, y + 120), release=False)
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert ui.session.graph is before

    gui(body)


def test_a_value_dragged_on_a_node_is_one_step(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        steps = ui.session.history.position
        ui.move("widget exposure.stops")
        ui.wait(2)
        x, y = ui.at("widget exposure.stops")
        ui.drag((x, y), (x + 30, y))
        assert ui.session.graph.value(Port("exposure", "stops")) > 0.5
        assert ui.session.history.position == steps + 1
        assert ui.session.position(ElementId("exposure")) == (320.0, 0.0)

    gui(body)


def test_a_choice_and_a_switch_on_nodes(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("gaussian_blur", "bloom"))
        ui.move("widget gaussian_blur.edge")
        ui.wait(2)
        ui.click("widget gaussian_blur.edge")
        ui.until(lambda: "choice mirror" in ui.editor.places)
        ui.wait(2)
        ui.click("choice mirror")
        ui.until(lambda: ui.session.graph.value(Port("gaussian_blur", "edge")) == "mirror")
        ui.until(lambda: "choice mirror" not in ui.editor.places)
        port = Port("bloom", "firefly")
        assert f"widget {port}" not in ui.editor.places
        ui.click("more bloom")
        ui.until(lambda: ui.editor.canvas.sizes["bloom"][1] > 200)
        ui.editor.canvas.fit((ElementId("bloom"),))
        ui.wait(3)
        before = ui.session.graph.value(port)
        ui.move(f"widget {port}")
        ui.wait(2)
        ui.click(f"widget {port}")
        ui.until(lambda: ui.session.graph.value(port) is not before)

    gui(body)


def test_what_is_arranged_is_in_view(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "saturation", "clip"))
        ui.editor.canvas.center = (ui.editor.canvas.center[0] + 2000.0, ui.editor.canvas.center[1] - 900.0)
        ui.session.select([])
        ui.move(empty(ui))
        ui.keys("L")
        ui.wait(4)
        left, top, right, bottom = ui.editor.places["Graph"]
        for node in ui.session.graph.nodes:
            x, y = ui.at(f"title {node}")
            assert left < x < right and top < y < bottom

    gui(body)


def test_the_keyboard_reaches_a_frame(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "saturation"))
        first = next(iter(ui.session.graph.nodes))
        ui.session.select([ElementId(first)])
        frame = ui.session.apply(AddFrame("Light", sizes=ui.editor.canvas.sizes))
        ui.session.select([ElementId(first)])
        ui.move(empty(ui))
        ui.wait(3)
        ui.keys("Alt+UpArrow")
        assert ui.session.active == frame
        ui.keys("Alt+DownArrow")
        assert ui.session.active == first

    gui(body)


def test_frames_take_along_what_lies_on_them(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip"))
        ui.session.select((ElementId("exposure"), ElementId("bloom")))
        frame = ui.session.apply(AddFrame("Light", sizes=ui.editor.canvas.sizes))
        ui.wait(3)
        before = {key: ui.session.position(key) for key in ("exposure", "bloom", "clip")}
        x, y = ui.at(f"title {frame}", (0.5, 0.5))
        ui.drag((x, y), (x + 10, y + 90))
        moved = {key: ui.session.position(key)[1] - place[1] for key, place in before.items()}
        assert moved["exposure"] > 50 and moved["bloom"] == moved["exposure"] and moved["clip"] == 0
        width = ui.editor.canvas.sizes[frame][0]
        ui.drag(ui.at(f"node {frame}", (1.0, 0.8)), ui.at(f"node {frame}", (1.1, 0.8)))
        assert ui.editor.canvas.sizes[frame][0] > width * 1.05

    gui(body)


def test_renames_a_frame_and_writes_a_comment_in_place(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        frame = ui.session.apply(AddFrame("", at=(0.0, 120.0)))
        comment = ui.session.apply(AddComment((400.0, 200.0), ""))
        ui.wait(3)
        ui.double_click(f"title {frame}", (0.3, 0.5))
        ui.wait(3)
        ui.type("Light")
        ui.until(lambda: ui.session.graph.ui["frames"][frame.name]["title"] == "Light")
        ui.double_click(f"node {comment}")
        ui.wait(3)
        ui.ctx.key_chars("Mind the gap")
        ui.wait(2)
        ui.click(empty(ui))
        assert ui.session.graph.ui["comments"][comment.name]["text"] == "Mind the gap"

    gui(body)


def test_enters_and_leaves_groups(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip"))
        ui.session.select((ElementId("bloom"),))
        group = ui.session.apply(MakeGroup("glow"))
        ui.wait(3)
        ui.double_click(f"title {group}", (0.3, 0.5))
        ui.wait(4)
        ui.until(lambda: ui.session.place == (group,))
        ui.until(lambda: "node bloom" in ui.editor.places)
        title = ui.session.crumbs[0][0]
        ui.click(f"crumb {title}")
        assert ui.session.place == ()

    gui(body)


def test_double_click_views_a_node(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        ui.double_click("title exposure", (0.3, 0.5))
        assert ui.session.views.find_port("A") == Port("exposure", "out")

    gui(body)


def test_wheel_zooms_about_the_pointer_and_middle_drag_pans(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.move("title exposure")
        ui.wait(2)
        zoom, spot = ui.editor.canvas.zoom, ui.editor.canvas.pointer
        ui.wheel(2)
        assert ui.editor.canvas.zoom > zoom * 1.2
        assert max(abs(a - b) for a, b in zip(ui.editor.canvas.pointer, spot, strict=True)) < 2
        center = ui.editor.canvas.center
        x, y = empty(ui)
        ui.drag((x, y), (x + 50, y + 20), button=2)
        scale = ui.editor.canvas.zoom
        assert abs(center[0] - ui.editor.canvas.center[0] - 50 / scale) < 1

    gui(body)


def test_fit_shows_everything_and_the_overview_moves_there(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip"))
        ui.editor.canvas.center = (9000.0, 9000.0)
        ui.wait(3)
        assert "node exposure" not in ui.editor.places
        ui.editor.canvas.fit()
        ui.wait(3)
        shown = {name for name in ui.editor.places if name.startswith("node ")}
        assert shown == {f"node {key}" for key in ui.session.elements}
        center = ui.editor.canvas.center
        if "minimap" in ui.editor.places:
            ui.click("minimap", fraction=(0.1, 0.5))
            assert ui.editor.canvas.center[0] < center[0]

    gui(body)


def test_dropped_files_land_at_the_pointer(gui, tmp_path) -> None:
    (tmp_path / "a.exr").write_bytes(b"")

    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.move(empty(ui))
        ui.wait(3)
        at = ui.editor.canvas.pointer
        ui.session.apply(DropFiles([tmp_path / "a.exr"], ui.editor.canvas.pointer))
        ui.wait(3)
        (id,) = set(ui.session.graph.nodes) - {"exposure"}
        x, y = ui.session.position(id)
        assert abs(x - at[0]) < 2 and abs(y - at[1]) < 2

    gui(body)


def test_fields_leave_the_wheel_and_the_right_button_to_the_canvas(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        port = Port("exposure", "stops")
        ui.session.apply(SetValue(port, 2.0))
        ui.move(f"widget {port}")
        ui.wait(2)
        zoom = ui.editor.canvas.zoom
        ui.wheel(1)
        assert ui.editor.canvas.zoom > zoom
        ui.click(f"widget {port}", button=1)
        ui.click("menu Reset stops")
        assert ui.session.graph.value(port) == 0.0

    gui(body)


def test_typing_a_number_on_a_node(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.move("widget exposure.stops")
        ui.wait(2)
        ui.click("widget exposure.stops")
        ui.move(empty(ui))
        ui.wait(2)
        ui.type("1.5")
        assert ui.session.graph.value(Port("exposure", "stops")) == 1.5

    gui(body)


def test_renames_a_node_in_place(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure"))
        ui.click("title exposure", fraction=(0.3, 0.5))
        ui.keys("F2")
        ui.wait(3)
        ui.type("brighter")
        assert "brighter" in ui.session.graph.nodes
        ui.click(empty(ui))
        ui.click("node outputs.image", fraction=(0.5, 0.5))
        ui.keys("F2")
        ui.wait(3)
        ui.type("final")
        assert set(ui.session.graph.outputs) == {"final"}

    gui(body)


def test_every_group_keeps_its_view(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom"))
        ui.session.select((ElementId("bloom"),))
        group = ui.session.apply(MakeGroup("glow"))
        ui.wait(3)
        before = ui.editor.canvas.center, ui.editor.canvas.zoom
        ui.session.enter(group)
        ui.wait(3)
        assert "node bloom" in ui.editor.places
        ui.session.leave()
        ui.wait(3)
        assert (ui.editor.canvas.center, ui.editor.canvas.zoom) == before

    gui(body)

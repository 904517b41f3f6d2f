"""Every tutorial, done in the editor as its sentences say, by mouse and keyboard."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from gui_driver import Ui
from halation import presets
from halation.authoring.edits.element_id import ElementId
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.tutorials.coach import READABLE_ZOOM, Coach, find_noted, fit_frame, place_card
from halation.editor.tutorials.course import COURSE
from halation.editor.tutorials.lessons import LESSONS
from selection import list_cases

Act = Callable[[Ui], object]


def open_lesson(ui: Ui, id: str) -> None:
    ui.window._contexts.tutorials.actions.run(f"tutorial.{id}")
    ui.settled()


def add(name: str) -> Act:
    def act(ui: Ui) -> None:
        ui.move("Graph", (0.5, 0.93))
        ui.keys("Tab")
        ui.type(name)

    return act


def click(place: str) -> Act:
    return lambda ui: (ui.reveal(place) if place.startswith("field ") else None, ui.click(place))


def open(place: str) -> Act:
    return lambda ui: ui.double_click(place)


def drag(place: str, across: float, down: float = 0.0) -> Act:
    def act(ui: Ui) -> None:
        if place.startswith(("field ", "wheel ")):
            ui.reveal(place)
        x, y = ui.at(place)
        ui.drag(place, (x + across, y + down))

    return act


def link(start: str, end: str) -> Act:
    return lambda ui: ui.drag(start, end)


def press(keys: str) -> Act:
    def act(ui: Ui) -> None:
        ui.move("Graph", (0.5, 0.93))
        ui.keys(keys)

    return act


def type_into(place: str, text: str) -> Act:
    return lambda ui: (ui.click(place), ui.type(text))


def both(*acts: Act) -> Act:
    return lambda ui: [act(ui) for act in acts]


def change_code(ui: Ui) -> None:
    ui.click("code text", fraction=(0.5, 0.9))
    ui.keys("Ctrl+Home")
    for key in ("End", "Enter"):
        ui.keys(key)
    ui.ctx.key_chars("// mine")
    ui.settled()


GO_ON = click("tutorial next")
ACTS: dict[str, tuple[Act, ...]] = {
    "first_look": (
        click("title bloom"),
        drag("field bloom.intensity", 40.0),
        add("vignette"),
        drag("handle vignette.center", 60.0, -30.0),
        open("title bloom"),
        open("title outputs.image"),
        press("Ctrl+Z"),
        GO_ON,
    ),
    "layers": (
        click("title neon"),
        click("pin out neon.depth"),
        add("fog"),
        open("title fog"),
        both(click("title fog"), drag("field fog.density", 30.0)),
        GO_ON,
    ),
    "masks": (
        click("title neon"),
        add("grade"),
        drag("wheel grade.gain", 20.0, 10.0),
        add("shape"),
        both(press("Home"), link("pin out shape.mask", "pin in grade.mask")),
        both(click("title shape"), drag("field shape.softness", 30.0)),
        both(click("title grade"), click("field grade.invert_mask")),
        GO_ON,
    ),
    "animation": (
        type_into("field timeline last", "24"),
        click("title bloom"),
        click("diamond bloom.intensity"),
        click("ruler 24"),
        drag("field bloom.intensity", 40.0),
        click("button time.play"),
        both(press("Space"), lambda ui: ui.ctx.window_focus("//Animation")),
        GO_ON,
    ),
    "own_glsl": (
        click("title neon"),
        add("code"),
        open("title code"),
        drag("field code.amount", 30.0),
        change_code,
        GO_ON,
    ),
}


@pytest.mark.parametrize("lesson", LESSONS, ids=lambda lesson: lesson.id)
def test_a_tutorial_goes_on_when_the_user_does_what_it_says(gui, lesson) -> None:
    def body(ui: Ui) -> None:
        open_lesson(ui, lesson.id)
        ui.shot(f"tutorial_{lesson.id}.png")
        ui.wait(5)
        progress = ui.window._contexts.tutorials.progress
        assert progress.lesson is lesson and len(ACTS[lesson.id]) == len(lesson.steps)
        for index, act in enumerate(ACTS[lesson.id]):
            assert progress.index == index, lesson.steps[index].sentence
            ui.until(lambda: "tutorial" in ui.editor.places)
            act(ui)
            ui.until(lambda index=index: progress.lesson is None or progress.index > index, 20.0)
            ui.wait(4)
        assert progress.lesson is None and not [entry for entry in ui.editor.log.entries if entry.level == "error"]

    gui(body, size=(1400, 900))


@pytest.mark.parametrize("lesson", LESSONS, ids=lambda lesson: lesson.id)
def test_a_step_is_about_a_widget_that_is_there(gui, lesson) -> None:
    """The user can go through a lesson without doing anything, back and forth; the first widget can be seen."""

    def body(ui: Ui) -> None:
        open_lesson(ui, lesson.id)
        assert lesson.steps[0].widget in ui.editor.places
        progress = ui.window._contexts.tutorials.progress
        ui.click("tutorial next")
        ui.until(lambda: "tutorial back" in ui.editor.places)
        ui.click("tutorial back")
        ui.until(lambda: progress.index == 0)
        ui.click("tutorial next")
        ui.click("tutorial end")
        assert progress.lesson is None and "tutorial" not in ui.editor.places

    gui(body)


PRESET = next(path for path in presets.paths() if path.stem == "soft_bloom")


def test_unsaved_work_is_asked_for_and_a_refusal_opens_no_tutorial(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        add("blur")(ui)
        ui.wait(3)
        open_lesson(ui, "masks")
        assert ui.editor.dialogs.question is not None
        ui.keys("Escape")
        ui.wait(3)
        assert ui.window._contexts.tutorials.progress.lesson is None

    gui(body, PRESET)


@pytest.mark.parametrize("size", [(640.0, 400.0), (1920.0, 1080.0)])
@pytest.mark.parametrize(
    "rect", [None, (10.0, 10.0, 60.0, 30.0), (580.0, 360.0, 630.0, 390.0), (0.0, 0.0, 640.0, 400.0), (300, 5, 340, 390)]
)
def test_the_card_is_inside_the_window_and_beside_its_widget(size, rect) -> None:
    x, y = place_card(rect, (320.0, 120.0), (0.0, 0.0, *size), 1.0)
    assert x >= 0.0 and y >= 0.0 and x + 320.0 <= size[0] and y + 120.0 <= size[1]
    if rect is not None and rect[2] - rect[0] < 100.0 and rect[3] - rect[1] < 100.0:
        assert x >= rect[2] or x + 320.0 <= rect[0] or y >= rect[3] or y + 120.0 <= rect[1]


def test_the_card_hides_no_note_if_there_is_another_place() -> None:
    viewer, area = (0.0, 0.0, 700.0, 300.0), (0.0, 0.0, 1000.0, 800.0)
    first = place_card(viewer, (320.0, 120.0), area, 1.0)
    assert first == (10.0, 314.0)
    x, y = place_card(viewer, (320.0, 120.0), area, 1.0, [(200.0, 330.0, 350.0, 350.0)])
    assert (x, y) == (380.0, 314.0), "below, at the other end"
    assert place_card(viewer, (320.0, 120.0), area, 1.0, [(0.0, 0.0, 1000.0, 800.0)]) == first, "nowhere is free"


def test_the_card_hides_no_node_if_there_is_another_place() -> None:
    title, area = (450.0, 540.0, 600.0, 564.0), (0.0, 0.0, 1366.0, 768.0)
    note, node, other = (450.0, 450.0, 610.0, 490.0), (450.0, 540.0, 600.0, 690.0), (240.0, 540.0, 390.0, 690.0)
    end = (660.0, 540.0, 780.0, 564.0)
    assert place_card(title, (320.0, 120.0), area, 1.0) == (450.0, 578.0), "below"
    x, y = place_card(title, (320.0, 120.0), area, 1.0, [note], [node, other, end])
    assert (x, y) == (614.0, 578.0), "below, at the right of the node"


def test_the_node_of_a_step_has_its_notes() -> None:
    places = {
        "box": (264.0, 0.0),
        "comments.c1": (264.0, -110.0),
        "comments.c2": (264.0, -400.0),
        "outputs.image": (9.0, 0.0),
    }
    named = {ElementId(name): place for name, place in places.items()}
    assert find_noted("title box", named) == ["box", "comments.c1"]
    assert find_noted("pin in box.image", named) == ["box", "comments.c1"]
    assert find_noted("title outputs.image", named) == ["outputs.image"]
    assert find_noted("Viewer", named) == find_noted("title gone", named) == []


@pytest.mark.parametrize("lesson", list_cases(COURSE[3:5], [*COURSE[:3], *COURSE[5:]]), ids=lambda lesson: lesson.id)
def test_notes_of_a_lesson_can_be_read_beside_its_task(gui, lesson) -> None:
    """In a window of 1366x768 each step shows its node with the notes above it, in letters of 13 pixels."""

    def body(ui: Ui) -> None:
        progress, canvas = ui.window._contexts.tutorials.progress, ui.editor.canvas
        ui.window._contexts.tutorials.actions.run(f"lesson.{lesson.id}")
        ui.wait(5)
        assert canvas.zoom >= READABLE_ZOOM
        for step in lesson.steps:
            ui.wait(4)
            left, top, right, bottom = ui.editor.places["Graph"]
            for key in find_noted(step.widget, ui.session.positions):
                if key.is_note:
                    x, y, end, below = ui.editor.places[f"title {key}"]
                    assert left <= x and end <= right and top <= y and below <= bottom, step.sentence
            if step is not lesson.steps[-1]:
                progress.go(1)

    gui(body, size=(1366, 740))


def test_the_frame_stays_inside_of_the_panel_of_its_widget() -> None:
    widgets = {"Viewer": (0.0, 0.0, 400.0, 300.0), "Inspector": (400.0, 0.0, 600.0, 300.0)}
    assert fit_frame((450.0, 100.0, 500.0, 120.0), widgets, 5.0) == (445.0, 95.0, 505.0, 125.0)
    assert fit_frame((402.0, 280.0, 598.0, 310.0), widgets, 5.0) == (400.0, 275.0, 600.0, 300.0), "cut at the edges"
    assert fit_frame((402.0, 290.0, 598.0, 340.0), widgets, 5.0) is None, "scrolled away"
    assert fit_frame((10.0, 310.0, 40.0, 330.0), widgets, 5.0) == (5.0, 305.0, 45.0, 335.0), "the timeline is no panel"


def test_no_frame_is_drawn_over_a_dialog(gui, monkeypatch: pytest.MonkeyPatch) -> None:
    frames: list[object] = []
    monkeypatch.setattr(Coach, "_draw_frame", lambda self, frame: frames.append(frame))

    def body(ui: Ui) -> None:
        open_lesson(ui, "first_look")
        ui.wait(2)
        assert frames
        ui.keys("F1")
        ui.until(lambda: ui.editor.dialogs.any)
        ui.wait(1)
        frames.clear()
        ui.wait(3)
        assert not frames and ui.editor.dialogs.any

    gui(body)


def test_a_lesson_of_the_course_shows_passes_is_solved_and_stays_finished(gui) -> None:
    """From the start screen to the check mark, with the mouse."""
    lesson = COURSE[2]

    def body(ui: Ui) -> None:
        ui.click("start lessons")
        ui.click(f"menu lesson.{lesson.id}")
        ui.settled()
        progress = ui.window._contexts.tutorials.progress
        assert progress.lesson is lesson and lesson.steps[0].widget in ui.editor.places
        ui.click("tutorial next")
        ui.until(lambda: len(ui.editor.passes.passes) == 2 and "Passes" in ui.editor.places)
        assert ui.editor.passes.passes[1].functions == ("convolve x",)
        ui.click("tutorial next")
        ui.shot("lesson_task.png")
        ui.click("tutorial solve")
        ui.until(lambda: progress.index == 3)
        ui.until(lambda: len(ui.editor.passes.passes) == 3)
        assert ui.editor.passes.passes[2].reads == ("1",), "the second pass reads the first"
        ui.click("tutorial back")
        ui.wait(5)
        assert progress.index == 2, "a task that is solved stays while the user reads it again"
        for _ in range(4):
            ui.click("tutorial next")
        assert progress.lesson is None and ui.editor.store.current.lessons == (lesson.id,)
        assert ui.editor.actions.is_checked(ui.editor.actions[f"lesson.{lesson.id}"])

    gui(body, size=(1400, 900))


def test_a_lesson_that_is_not_solved_is_not_finished(gui) -> None:
    def body(ui: Ui) -> None:
        ui.window._contexts.tutorials.actions.run("lesson.convolution")
        ui.settled()
        progress = ui.window._contexts.tutorials.progress
        while progress.lesson is not None:
            ui.click("tutorial next")
        assert not ui.editor.store.current.lessons

    gui(body)


def test_a_lesson_brings_the_graph_to_the_front(gui) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.editor.commands.show_panel(PanelTitle.CODE)
        ui.until(lambda: "Graph" not in ui.editor.places)
        open_lesson(ui, "first_look")
        ui.until(lambda: "Graph" in ui.editor.places and "title bloom" in ui.editor.places)

    gui(body)

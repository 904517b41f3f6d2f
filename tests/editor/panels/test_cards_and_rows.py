"""The card of a tutorial and the rows of the start screen: what their parts do, and how they lie."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from halation import presets
from halation.editor.theme.palette import DARK
from halation.editor.theme.style import u32
from halation.editor.tutorials import coach
from halation.editor.tutorials.course import COURSE
from halation.editor.viewer import ground
from halation.editor.workflows.documents import DocumentWorkflow
from halation.graph import Graph, Port
from still_editor import StillEditor, open_still_editor

LESSON = COURSE[2]
TASK = next(index for index, step in enumerate(LESSON.steps) if step.solution)
GONE = Path("/pictures/a/long/way/down/gone_with_the_wind.json")


def begin(still: StillEditor, index: int) -> Any:
    progress = still.contexts.tutorials.progress
    progress.begin(LESSON)
    still.show("Tutorial", 2)
    progress.go(index - progress.index)
    still.show("Tutorial", 2)
    return progress


@pytest.mark.parametrize("index", [0, 1, TASK, len(LESSON.steps) - 1])
def test_a_card_has_the_buttons_of_its_step_in_one_line(tmp_path: Path, index: int) -> None:
    """The first step has none before it, the last one none behind it, and only a task can be done for the user."""
    step = LESSON.steps[index]
    expected = [
        *(["back"] if index else []),
        "next",
        *(["solve"] if step.solution else []),
        *(["end"] if index < len(LESSON.steps) - 1 else []),
    ]
    with open_still_editor(tmp_path, Graph()) as still:
        begin(still, index)
        boxes = {name: box for name, box in still.places.items() if name.startswith("tutorial ")}
        assert [*boxes] == [f"tutorial {name}" for name in expected]
        rows = [(box[1], box[3]) for box in boxes.values()]
        assert len({*rows}) == 1, "one line"
        lefts = [box[0] for box in boxes.values()]
        gaps = [after - box[2] for after, box in zip(lefts[1:], boxes.values(), strict=False)]
        assert lefts == sorted(lefts) and max(gaps, default=1.0) == min(gaps, default=1.0) > 0.0
        card = still.places["tutorial"]
        assert all(card[0] < box[0] and box[2] < card[2] and box[3] < card[3] for box in boxes.values())


def test_the_buttons_of_a_card_do_what_they_say(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, presets.paths()[0]) as still:
        for name, change in (("next", 1), ("back", -1)):
            progress = begin(still, TASK)
            still.click("Tutorial", f"tutorial {name}")
            assert progress.lesson is LESSON and progress.index == TASK + change
        progress = begin(still, TASK)
        still.click("Tutorial", "tutorial end")
        assert progress.lesson is None
        asked = list[object]()
        still.editor.session.apply = lambda command: asked.append(command)  # pyright: ignore[reportAttributeAccessIssue]
        try:
            begin(still, TASK)
            still.click("Tutorial", "tutorial solve")
        finally:
            del still.editor.session.apply
        assert tuple(asked) == tuple(LESSON.steps[TASK].solution)


def test_rows_of_documents_hold_a_picture_of_a_screens_shape_and_two_lines_beside_it(tmp_path: Path) -> None:
    with open_still_editor(tmp_path, Graph(), size=(1300.0, 700.0)) as still:
        paths = [*presets.paths()[:2], GONE]
        for path in paths:
            still.editor.store.note_opened(path)
        still.editor.dialogs.open.add("start")
        still.show("Start", 4)
        drawing = still.pane.copy()
        for index, path in enumerate(reversed(paths)):
            left, top, right, bottom = still.places[f"recent {index}"]
            (picture,) = [
                (*shape.points[0], *shape.points[1])
                for shape in drawing.shapes
                if shape.kind == "filled rect" and shape.color == u32(DARK.raised)
                and left <= shape.points[0][0] < right and top <= shape.points[0][1] < bottom
            ]  # fmt: skip
            wide, high = picture[2] - picture[0], picture[3] - picture[1]
            assert wide / high == pytest.approx(16 / 9, rel=0.05) and wide < 0.4 * (right - left)
            assert picture[0] > left and picture[1] - top == pytest.approx(bottom - picture[3], abs=1.0)
            inside = [seen for seen in drawing.texts if top <= (seen.box[1] + seen.box[3]) / 2 <= bottom]
            name, folder = [seen for seen in inside if left < seen.box[0] < right]
            assert path.stem.startswith(name.words.partition("…")[0]) and folder.words[:4] == str(path.parent)[:4]
            assert name.box[0] == folder.box[0] > picture[2] and name.box[3] <= folder.box[1] + 1.0
            assert name.box[1] - top == pytest.approx(bottom - folder.box[3], abs=4.0)
            assert max(name.box[2], folder.box[2]) < right


def test_a_document_is_opened_or_missed_or_forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_still_editor(tmp_path, Graph(), size=(1300.0, 700.0)) as still:
        opened, store = list[Path](), still.editor.store
        monkeypatch.setattr(DocumentWorkflow, "open_graph", lambda documents, path: opened.append(path))
        for path in (presets.paths()[0], GONE):
            store.note_opened(path)
        still.editor.dialogs.open.add("start")
        still.show("Start", 4)
        still.click("Start", "recent 0")
        assert not opened and str(GONE) in str(still.editor.log.entries[-1])
        still.click("Start", "recent 1")
        assert opened == [presets.paths()[0]]
        still.pane.point(still.find_point("recent 0"))
        still.show("Start", 3)
        still.click("Start", "forget 0")
        assert [recent.path for recent in store.current.recent] == [str(presets.paths()[0])] and len(opened) == 1


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(
    ("share", "pixel"), [(0.0, 0), (0.5, 4), (0.99, 7), (0.125, 1), (1.0, None), (-0.01, None), (1.5, None)]
)
def test_a_point_of_the_picture_is_in_one_pixel_and_one_beside_it_in_none(
    monkeypatch: pytest.MonkeyPatch, axis: int, share: float, pixel: int | None
) -> None:
    read = list[tuple[int, int]]()
    port = Port("node", "depth")
    monkeypatch.setattr(ground, "depths", lambda context: {"depth": port})
    image = SimpleNamespace(port=port, full_size=(8, 8))
    context: Any = SimpleNamespace(
        preview=SimpleNamespace(find_whole_image=lambda name: image),
        session=SimpleNamespace(place=()),
        probe=None,
        viewer=SimpleNamespace(
            reader=SimpleNamespace(read_pixel=lambda probe, name, image, at: (read.append(at), (1.0,))[1])
        ),
    )
    at = (share, 0.25) if axis == 0 else (0.25, share)
    assert (ground.depth_at(context, at) == 1.0) is (pixel is not None)
    assert read == ([] if pixel is None else [(pixel, 2) if axis == 0 else (2, pixel)])


def test_nothing_is_known_without_a_link_or_a_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    port = Port("node", "depth")
    for ports, image in (({}, SimpleNamespace(port=port, full_size=(8, 8))), ({"depth": port}, None)):
        monkeypatch.setattr(ground, "depths", lambda context, ports=ports: ports)
        context: Any = SimpleNamespace(preview=SimpleNamespace(find_whole_image=lambda name, image=image: image))
        assert ground.depth_at(context, (0.5, 0.5)) is None


@pytest.mark.parametrize("index", [0, TASK])
def test_next_is_lit_where_there_is_nothing_to_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, index: int) -> None:
    seen = dict[str, tuple[str, bool]]()
    with open_still_editor(tmp_path, Graph()) as still:
        begin(still, index)
        monkeypatch.setattr(
            coach, "quiet_button", lambda context, label, name, doc, lit: seen.update({name: (doc, lit)})
        )
        still.show("Tutorial", 1)
    is_read = LESSON.steps[index].is_done is None
    assert {name for name, (_, lit) in seen.items() if lit} == ({"tutorial next"} if is_read else set())
    assert {name for name, (doc, _) in seen.items() if doc} == {*seen} - {"tutorial next", "tutorial back"}


def test_keys_end_where_the_line_of_their_block_ends(tmp_path: Path) -> None:
    """And the title of a block begins where its line begins."""
    with open_still_editor(tmp_path, Graph(), screen=(3000.0, 3000.0)) as still:
        still.editor.dialogs.open.add("shortcuts")
        still.show("Shortcuts", 4)
        drawing = still.pane.copy()
        lines = [shape.points for shape in drawing.shapes if shape.kind == "line"]
        words = [shape for shape in drawing.widgets if shape.kind == "text_colored"]
        assert lines and len(words) > 2 * len(lines)
        titles = 0
        for word in words:
            (left, _), (right, _) = word.points
            is_title = any(abs(left - start[0]) < 1.0 for start, _ in lines)
            titles += is_title
            assert is_title or any(abs(right - end[0]) < 1.0 for _, end in lines), word
        assert titles == len(lines)


def test_of_what_sticks_out_of_the_graph_only_what_is_seen_counts() -> None:
    """A card may lie over the rest, which is behind other panels."""
    widgets = {
        "Graph": (100.0, 50.0, 500.0, 400.0), "title a": (0.0, 0.0, 9.0, 9.0), "node a": (80.0, 60.0, 200.0, 90.0),
        "node b": (450.0, 30.0, 530.0, 420.0), "node c": (150.0, 100.0, 250.0, 200.0),
    }  # fmt: skip
    seen = coach._list_seen(widgets, "node ")  # pyright: ignore[reportPrivateUsage]
    assert seen == [(100.0, 60.0, 200.0, 90.0), (450.0, 50.0, 500.0, 400.0), (150.0, 100.0, 250.0, 200.0)]

"""The rows of the queue of renders while they change."""

from __future__ import annotations

import copy
from pathlib import Path

from gui_renders import make_render


def test_no_button_moves_while_a_render_goes_on(gui, tmp_path: Path) -> None:
    """A click that was aimed at one meets it even if the first file, a message, or the end comes in between."""
    render = make_render(tmp_path / "comp.####.exr", "running", total=8)
    written = tuple(tmp_path / f"comp.{frame:04d}.exr" for frame in range(1, 9))
    told = {"notes": ("image: clipped to 16 bit",)}
    courses: dict[str, tuple[dict[str, object], ...]] = {
        "done": (
            {"written_files": written[:1], "done": 1},
            told,
            {"state": "done", "written_files": written, "done": 8},
        ),
        "told at the end": ({"written_files": written[:1]}, {"state": "done", "written_files": written} | told),
        "cancelled": ({"written_files": written[:2], "done": 2}, told, {"state": "cancelled"}),
        "failed at once": ({"state": "failed", "failure": "no such folder"} | told,),
    }

    met, moved = dict.fromkeys(courses, frozenset[str]()), dict[str, object]()

    def follow(ui, course: str) -> None:
        ui.editor.exports.all = (following := copy.copy(render),)
        before = dict[str, object]()
        for change in ({}, *courses[course]):
            vars(following).update(change)
            ui.wait(2)
            ui.editor.places.clear()
            ui.wait(3)
            now = {
                name: place for name, place in ui.editor.places.items() if name.endswith(" 0") and name != "export 0"
            }
            moved.update({f"{course}: {name}": now[name] for name in now.keys() & before if now[name] != before[name]})
            before |= now
        met[course] = frozenset(before)

    def body(ui) -> None:
        ui.show_panel("Renders")
        for course in courses:
            follow(ui, course)
        ui.editor.exports.all = ()  # there is no process that could be cancelled

    gui(body)
    assert not moved
    assert all(
        {"cancel 0", "play 0", "compare 0", "notes 0", "copy path 0", "open folder 0"} <= met[one] for one in met
    )

"""The screens of lessons."""

from collections.abc import Iterator

from gui_driver import Ui
from halation.editor.tutorials.course import COURSE


def lessons(ui: Ui) -> Iterator[str]:
    """The card of a lesson with all of its buttons."""
    lesson = COURSE[2]
    progress = ui.window._contexts.tutorials.progress
    progress.begin(lesson)
    progress.go(next(index for index, step in enumerate(lesson.steps) if step.solution))
    ui.wait(3)
    yield "lesson"
    progress.begin(None)

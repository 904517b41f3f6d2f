"""The actions that open a tutorial."""

from __future__ import annotations

from functools import partial

from halation import presets

from ..shared.action import Action
from .context import TutorialContext
from .lesson import Lesson
from .lessons import LESSONS


def open_lesson(context: TutorialContext, lesson: Lesson) -> None:
    """Open the document that a lesson begins with, after asking about unsaved work, and show its first step."""
    files = {path.stem: path for path in presets.paths()}
    begin = partial(context.progress.begin, lesson)
    if lesson.start == "sample":
        context.documents.open_picture(files["soft_bloom"].parent / "samples" / "neon.exr", begin)
    else:
        context.documents.open_preset(files[lesson.start], begin)


TUTORIALS: tuple[Action[TutorialContext], ...] = tuple(
    Action(
        f"tutorial.{lesson.id}",
        lesson.title,
        partial(open_lesson, lesson=lesson),
        "Help/Tutorials",
        doc=f"{lesson.doc} Five minutes, on the sample render.",
    )
    for lesson in LESSONS
)

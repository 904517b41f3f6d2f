"""The actions that open a tutorial or a lesson of the course."""

from __future__ import annotations

from functools import partial

from ...media.pictures.file_endings import is_picture
from ..shared.action import Action
from .context import TutorialContext
from .course import COURSE
from .lesson import Lesson
from .lessons import LESSONS


def open_lesson(context: TutorialContext, lesson: Lesson) -> None:
    """Open the document that a lesson begins with, after asking about unsaved work, and show its first step."""

    def begin() -> None:
        context.session.select(())  # a first step may ask for it
        context.progress.begin(lesson)

    documents = context.documents
    (documents.open_picture if is_picture(lesson.start_file) else documents.open_preset)(lesson.start_file, begin)


def is_finished(context: TutorialContext, lesson: Lesson) -> bool:
    """True if the user has been through a lesson."""
    return lesson.id in context.interface.store.current.lessons


TUTORIALS: tuple[Action[TutorialContext], ...] = tuple(
    Action(
        f"tutorial.{lesson.id}",
        lesson.title,
        partial(open_lesson, lesson=lesson),
        "Help/Tutorials",
        checked=partial(is_finished, lesson=lesson),
        doc=f"{lesson.doc} Five minutes, on the sample render.",
    )
    for lesson in LESSONS
) + tuple(
    Action(
        f"lesson.{lesson.id}",
        f"{number}. {lesson.title}",
        partial(open_lesson, lesson=lesson),
        "Help/Lessons",
        checked=partial(is_finished, lesson=lesson),
        doc=lesson.doc,
    )
    for number, lesson in enumerate(COURSE, 1)
)
"""The tutorials of the editor, then the course."""

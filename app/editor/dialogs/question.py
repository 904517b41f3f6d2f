"""The dialog for a question that must be answered first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from imgui_bundle import imgui

from ..shared.dialogs import Question
from ..theme.style import ui_scale
from ..toolkit.buttons import main_button
from ..toolkit.dialogs import backdrop, dialog, enter_pressed, escape_pressed
from ..toolkit.labels import make_label
from ..toolkit.places import record
from ..toolkit.words import font

if TYPE_CHECKING:
    from .context import DialogContext


class QuestionDialog:
    """Answers as buttons: Enter chooses the one in the focus ring, else the first; Escape the last, the safest."""

    def __init__(self, context: DialogContext) -> None:
        self._context = context

    def draw(self) -> None:
        """Draw the dialog, if there is a question."""
        question = self._context.dialogs.question
        if question is None:
            return
        backdrop(self._context, "question")
        chosen: int | None = None
        with dialog(self._context, "Question", (460, 0), top=0.4):
            with font(self._context, "bold", 18.0):
                imgui.text_unformatted(question.title)
            imgui.dummy((0, 2 * ui_scale()))
            imgui.text_wrapped(question.sentence)
            imgui.dummy((0, 8 * ui_scale()))
            chosen = _draw_buttons(self._context, question)
            if escape_pressed():
                chosen = len(question.answers) - 1
            elif enter_pressed():
                chosen = 0
        if chosen is not None:
            self._context.dialogs.question = None
            self._context.log.attempt(question.answers[chosen][1])


def _draw_buttons(context: DialogContext, question: Question) -> int | None:
    """Draw the buttons in a row from the right, or below each other if they do not fit; returns the clicked index."""
    style = imgui.get_style()
    labels = [answer for answer, _ in question.answers]
    width = sum(imgui.calc_text_size(label).x + 2 * style.frame_padding.x for label in labels)
    width += style.item_spacing.x * (len(labels) - 1)
    room = imgui.get_content_region_avail().x
    beside = width <= room
    if beside:
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + room - width)
    chosen = None
    for index, label in enumerate(labels):
        name, across = f"answer {index}", 0.0 if beside else -1.0
        if (
            main_button(context, label, name, width=across)
            if index == 0
            else imgui.button(make_label(label, name), (across, 0))
        ):
            chosen = index
        if index == 0:
            imgui.set_item_default_focus()
        record(context, name)
        if beside and index + 1 < len(labels):
            imgui.same_line()
    return chosen

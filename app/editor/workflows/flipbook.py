"""Flipbooks: finished pictures played in place of the document, or two sequences of them compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...authoring.services.flipbook import Flipbook, Strip
from ..shared.action import Action
from ..shared.dialogs import Browse

if TYPE_CHECKING:
    from ..window.editor import Editor


def open_flipbook(editor: Editor, *strips: Strip) -> None:
    """Play these in the viewer; two are side by side unless they are compared otherwise already."""
    viewer, session, before = editor.viewer, editor.session, editor.viewer.flipbook
    watched = before.watched if before else session.viewed_in_root("A")
    frame = before.session.frame if before else session.frame
    made = Flipbook(strips, session.settings.rate, frame, watched)
    editor.timeline.stop()
    viewer.compare_after = viewer.compare_after if before else viewer.compare
    viewer.flipbook = made
    if len(strips) == 1:
        viewer.compare = "off"
    elif not viewer.compares:
        viewer.compare = "beside"
    viewer.fit()
    editor.requests.add("show Viewer")


def close_flipbook(editor: Editor) -> None:
    """Show the document again."""
    viewer = editor.viewer
    if viewer.flipbook is not None:
        editor.timeline.stop()
        viewer.compare, viewer.flipbook = viewer.compare_after, None


def choose_flipbook(editor: Editor, first: Strip | None = None) -> None:
    """Ask for pictures to play, alone or beside others."""

    def chosen(path: Path) -> None:
        strip = Strip.chosen(path)
        open_flipbook(editor, *(first, strip) if first else (strip,))

    title = f"Compare {first.name} with" if first else "Play pictures"
    editor.dialogs.browse = Browse(title, "image", chosen)


def follow_flipbook(editor: Editor) -> None:
    """Every frame: show what has been written meanwhile, and the document again as soon as someone looks at it."""
    book = editor.viewer.flipbook
    if book is None:
        return
    if editor.session.viewed_in_root("A") != book.watched:
        close_flipbook(editor)
    elif book.follow(editor.preview.frames):
        editor.preview.refresh()


FLIPBOOK: tuple[Action, ...] = (
    Action(
        "flipbook.open",
        "Play Pictures...",
        choose_flipbook,
        "Viewer",
        separated=True,
        doc="A sequence on the disk, in place of the document.",
    ),
    Action(
        "flipbook.compare",
        "Compare Pictures with...",
        lambda e: choose_flipbook(e, e.viewer.flipbook.strips[0]),
        "Viewer",
        enabled=lambda e: e.viewer.flipbook is not None,
        doc="Play another sequence beside this one.",
    ),
    Action(
        "flipbook.close",
        "Back to the Graph",
        close_flipbook,
        "Viewer",
        enabled=lambda e: e.viewer.flipbook is not None,
        doc="End the flipbook.",
    ),
)

"""The open dialogs, the file that is asked for, and the open question. Panels draw them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from halation.nodes import Value
from msgspec import Struct, field

from ...language.translation import translate
from .window_commands import PanelTitle

Purpose = Literal["graph", "image", "table", "scene", "font", "config", "code", "export"]
"""The kind of file: it decides which files are listed and which folder is remembered."""


class Browse(Struct, frozen=True):
    """A request for a file, which `then` gets. `saving` asks for a new name, starting from `name`.

    With `has_pictures` a picture will do as well as a graph.
    """

    title: str
    purpose: Purpose
    then: Callable[[Path], object]
    saving: bool = False
    name: str = ""
    has_pictures: bool = False


def browse(declaration: Value, then: Callable[[Path], object]) -> Browse:
    """A request for a file of the kind that a value takes."""
    match declaration.holds:
        case "table":
            return Browse(translate("Choose a Color Table"), "table", then)
        case "scene":
            return Browse(translate("Choose Meshes"), "scene", then)
        case "font":
            return Browse(translate("Choose a Font"), "font", then)
        case "picture" | "render":
            return Browse(translate("Choose an Image"), "image", then)


class Question(Struct, frozen=True):
    """A question with answers, the safest one last; Escape chooses that one."""

    title: str
    sentence: str
    answers: tuple[tuple[str, Callable[[], object]], ...]


class Dialogs(Struct):
    """What is open on top of the panels: at most one dialog of each kind."""

    browse: Browse | None = None
    question: Question | None = None
    open: set[str] = field(default_factory=set[str])
    """Names of open dialogs: "palette", "shortcuts", "preferences", "export", "about", "start", "search", "preset",
    "node", "panel"."""
    page: PanelTitle | None = None
    """The panel that the dialog "panel" explains."""
    matches: bool = False
    """Whether the window is open that matches a reference. It is no dialog: people work on beside it."""

    def toggle(self, name: str) -> None:
        """Open a dialog, or close it."""
        self.open ^= {name}

    def close(self) -> None:
        """Close everything."""
        self.browse = self.question = None
        self.open.clear()

    @property
    def any(self) -> bool:
        """True if a dialog, a question or a request for a file is open."""
        return self.browse is not None or self.question is not None or bool(self.open)

"""Flipbooks: finished pictures played in place of the document, or two sequences of them compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from msgspec import Struct

from ...authoring.flipbook import Flipbook, FlipbookStrip
from ...language.translation import translate
from ..shared.action import Action
from ..shared.dialogs import Browse
from ..shared.window_commands import PanelTitle

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import Player
    from ..shared.stage import DocumentStage
    from ..shared.window_commands import WindowCommands
    from ..toolkit.services import Services


class FlipbookScreen(Protocol):
    """The viewer, as far as flipbooks need it."""

    def begin_flipbook(self, count: int, *, again: bool) -> None:
        """Show one sequence or compare two; `again` if another flipbook is on the screen."""
        ...

    def end_flipbook(self) -> None:
        """Compare as before the flipbook."""
        ...


class FlipbookPlayer(Struct, frozen=True):
    """Puts flipbooks on the stage, and the document back."""

    stage: DocumentStage
    viewer: FlipbookScreen
    timeline: Player
    preview: Preview
    dialogs: Dialogs
    commands: WindowCommands

    @classmethod
    def compose(cls, services: Services, viewer: FlipbookScreen, timeline: Player) -> FlipbookPlayer:
        """Pick what flipbooks use."""
        return cls(services.stage, viewer, timeline, services.preview, services.dialogs, services.commands)

    def open(self, *strips: FlipbookStrip) -> None:
        """Play sequences in the viewer; two are side by side unless they are compared otherwise already."""
        document, before = self.stage.document, self.stage.flipbook
        watched = before.watched if before else document.views.find_root_port("A")
        frame = before.session.time.frame if before else document.time.frame
        flipbook = Flipbook(strips, document.root.settings.rate, frame, watched)
        self.timeline.stop()
        self.viewer.begin_flipbook(len(strips), again=before is not None)
        self.stage.flipbook = flipbook
        self.commands.show_panel(PanelTitle.VIEWER)

    def close(self) -> None:
        """Show the document again."""
        if self.stage.flipbook is not None:
            self.timeline.stop()
            self.viewer.end_flipbook()
            self.stage.flipbook = None

    def choose(self, first: FlipbookStrip | None = None) -> None:
        """Ask for pictures to play, alone or beside others."""

        def play(path: Path) -> None:
            strip = FlipbookStrip.from_file(path, sandbox=self.stage.document.sandbox)
            self.open(*(first, strip) if first else (strip,))

        title = translate("Compare {name} with", name=first.name) if first else translate("Play pictures")
        self.dialogs.browse = Browse(title, "image", play)

    def choose_other(self) -> None:
        """Ask for pictures to compare with those that are played."""
        if self.stage.flipbook is not None:
            self.choose(self.stage.flipbook.strips[0])

    def follow(self) -> None:
        """Show what a render has written since the last frame of the window.

        The document comes back as soon as the user looks at another of its pictures.
        """
        flipbook = self.stage.flipbook
        if flipbook is None:
            return
        if self.stage.document.views.find_root_port("A") != flipbook.watched:
            self.close()
        elif flipbook.follow(self.preview.frames):
            self.preview.refresh()


def _is_open(player: FlipbookPlayer) -> bool:
    return player.stage.flipbook is not None


FLIPBOOK: tuple[Action[FlipbookPlayer], ...] = (
    Action(
        "flipbook.open",
        "Play Pictures...",
        FlipbookPlayer.choose,
        "Viewer",
        separated=True,
        doc="Play a sequence of files in place of the document.",
    ),
    Action(
        "flipbook.compare",
        "Compare Pictures with...",
        FlipbookPlayer.choose_other,
        "Viewer",
        enabled=_is_open,
        doc="Play another sequence beside this one.",
    ),
    Action(
        "flipbook.close",
        "Back to the Graph",
        FlipbookPlayer.close,
        "Viewer",
        enabled=_is_open,
        doc="Close the flipbook.",
    ),
)

"""What the tutorials use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct, field

from ..toolkit.context import PanelContext
from ..toolkit.places import Rect
from .lesson import Lesson
from .moment import Moment

if TYPE_CHECKING:
    from ...authoring.preview.pass_pictures import PassPictures
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import ElementView
    from ..shared.window_commands import WindowCommands
    from ..toolkit.services import Services
    from ..workflows.documents import DocumentWorkflow


class LessonProgress(Struct):
    """The lesson that is open, and how far the user is."""

    lesson: Lesson | None = None
    index: int = 0
    beginning: Moment | None = None
    """The moment in which the step began; None until it is drawn."""
    went_back: bool = False
    """True if the user came back to the step, which may be done already: it stays until he goes on."""
    widgets: dict[str, Rect] = field(default_factory=dict[str, Rect])
    """Where widgets were in the last whole frame, while a lesson is open."""

    def note_widgets(self, places: dict[str, Rect]) -> None:
        """Keep the places of a frame: what lies on top of the panels is drawn before them."""
        if self.lesson is not None:
            self.widgets = dict(places)

    def begin(self, lesson: Lesson | None) -> None:
        """Open a lesson at its first step; None closes the open one."""
        self.lesson, self.index, self.beginning, self.went_back = lesson, 0, None, False

    def go(self, by: int) -> None:
        """Go to another step; beyond the last one the lesson is over."""
        assert self.lesson is not None
        index = max(self.index + by, 0)
        if index < len(self.lesson.steps):
            self.index, self.beginning, self.went_back = index, None, by < 0
        else:
            self.begin(None)


class TutorialContext(PanelContext, frozen=True):
    """The collaborators of the tutorials."""

    session: Session
    canvas: ElementView
    dialogs: Dialogs
    actions: Actions
    commands: WindowCommands
    passes: PassPictures
    documents: DocumentWorkflow
    progress: LessonProgress = field(default_factory=LessonProgress)

    @classmethod
    def compose(cls, services: Services, canvas: ElementView, documents: DocumentWorkflow) -> TutorialContext:
        """Pick what the tutorials use."""
        return cls(
            services.interface,
            services.log,
            services.session,
            canvas,
            services.dialogs,
            services.actions,
            services.commands,
            services.passes,
            documents,
        )

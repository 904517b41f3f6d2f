"""What the viewer, the timeline and the scopes show: the document, or a flipbook in its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

if TYPE_CHECKING:
    from ...authoring.flipbook import Flipbook
    from ...authoring.session import Session


class DocumentStage(Struct):
    """The document, and the flipbook that is played in its place while one is open."""

    document: Session
    flipbook: Flipbook | None = None

    @property
    def session(self) -> Session:
        """The session whose pictures and time are shown."""
        return self.document if self.flipbook is None else self.flipbook.session

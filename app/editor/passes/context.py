"""What the Passes panel uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preview.pass_pictures import PassPictures
    from ...authoring.session import Session
    from ..toolkit.services import Services


class PassesContext(PanelContext, frozen=True):
    """The collaborators of the Passes panel."""

    session: Session
    pictures: PassPictures

    @classmethod
    def compose(cls, services: Services) -> PassesContext:
        """Pick what the panel uses."""
        return cls(services.interface, services.log, services.session, services.passes)

"""What the Code panel uses."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..toolkit.services import Services
    from ..workflows.code_files import CodeFileWorkflow
    from .state import CodeState


class CodeContext(PanelContext, frozen=True):
    """The collaborators of the Code panel."""

    session: Session
    code: CodeState
    preview: Preview
    actions: Actions
    code_files: CodeFileWorkflow

    @classmethod
    def compose(cls, services: Services, code: CodeState, code_files: CodeFileWorkflow) -> CodeContext:
        """Pick what the panel uses."""
        return cls(
            services.interface, services.log, services.session, code, services.preview, services.actions, code_files
        )

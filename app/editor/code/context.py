"""What the Code panel uses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.preview import Preview
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..workflows.code_files import CodeFileWorkflow
    from .state import CodeState


@dataclass(frozen=True)
class CodeContext(PanelContext):
    """The collaborators of the Code panel."""

    session: Session
    code: CodeState
    preview: Preview
    actions: Actions
    code_files: CodeFileWorkflow

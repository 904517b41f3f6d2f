"""The collaborators of the canvas."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..toolkit.context import PanelContext

if TYPE_CHECKING:
    from ...authoring.background.shader_files import ShaderFiles
    from ...authoring.library import PresetLibrary
    from ...authoring.preferences import PreferenceStore
    from ...authoring.preview import Preview
    from ...authoring.session import Session
    from ..shared.action import Actions
    from ..shared.dialogs import Dialogs
    from ..shared.protocols import PixelPicker
    from ..toolkit.services import Services
    from ..workflows.code_files import CodeFileWorkflow
    from ..workflows.documents import DocumentWorkflow
    from .view import CanvasView


class CanvasContext(PanelContext, frozen=True):
    """The collaborators of the canvas."""

    session: Session
    canvas: CanvasView
    preview: Preview
    store: PreferenceStore
    actions: Actions
    dialogs: Dialogs
    shaders: ShaderFiles
    library: PresetLibrary
    viewer: PixelPicker
    documents: DocumentWorkflow
    code_files: CodeFileWorkflow

    @classmethod
    def compose(
        cls,
        services: Services,
        canvas: CanvasView,
        viewer: PixelPicker,
        documents: DocumentWorkflow,
        code_files: CodeFileWorkflow,
    ) -> CanvasContext:
        """Pick what the panel uses."""
        return cls(
            services.interface,
            services.log,
            services.session,
            canvas,
            services.preview,
            services.store,
            services.actions,
            services.dialogs,
            services.shaders,
            services.library,
            viewer,
            documents,
            code_files,
        )

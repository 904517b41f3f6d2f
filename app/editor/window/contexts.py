"""What each panel, and each group of actions, receives from the editor."""

from __future__ import annotations

from msgspec import Struct

from ..actions.context import EditContext, ViewSettingsContext
from ..actions.edits import EDITS
from ..actions.view import VIEW
from ..browser.context import BrowserContext
from ..canvas.actions import GRAPH
from ..canvas.context import CanvasContext
from ..canvas.walking import WALKING
from ..code.context import CodeContext
from ..command_palette.context import PaletteContext
from ..curves.actions import ANIMATION
from ..curves.context import CurvesContext
from ..dialogs.context import DialogContext
from ..exporting.context import ExportContext
from ..history.context import HistoryContext
from ..inspector.context import InspectorContext
from ..library.context import PresetContext
from ..log.context import LogContext
from ..matching.context import MatchContext
from ..passes.context import PassesContext
from ..preferences.context import PreferencesContext
from ..problems.context import ProblemsContext
from ..renders.context import RendersContext
from ..start.context import StartContext
from ..timeline.actions import PLAYBACK
from ..timeline.context import TimelineContext
from ..tutorials.actions import TUTORIALS
from ..tutorials.context import TutorialContext
from ..viewer.actions import VIEWER
from ..viewer.context import ViewerContext
from ..viewer.handle_actions import HANDLES
from ..viewer.spline_actions import SPLINE_ACTIONS
from ..workflows.code_files import CODE, CodeFileWorkflow
from ..workflows.documents import DOCUMENTS, DocumentWorkflow
from ..workflows.flipbook import FLIPBOOK, FlipbookPlayer
from .editor import Editor


class Contexts(Struct, frozen=True):
    """One context for each panel, and the workflows that several of them share."""

    documents: DocumentWorkflow
    code_files: CodeFileWorkflow
    flipbooks: FlipbookPlayer
    browser: BrowserContext
    canvas: CanvasContext
    code: CodeContext
    command_palette: PaletteContext
    curves: CurvesContext
    dialogs: DialogContext
    exporting: ExportContext
    history: HistoryContext
    inspector: InspectorContext
    log: LogContext
    matching: MatchContext
    passes: PassesContext
    presets: PresetContext
    preferences: PreferencesContext
    problems: ProblemsContext
    renders: RendersContext
    start: StartContext
    timeline: TimelineContext
    tutorials: TutorialContext
    viewer: ViewerContext


def compose_contexts(editor: Editor) -> Contexts:
    """Give each panel its collaborators."""
    code_files = CodeFileWorkflow.compose(editor, editor.code)
    documents = DocumentWorkflow.compose(editor, editor.canvas, code_files, editor.viewer)
    flipbooks = FlipbookPlayer.compose(editor, editor.viewer, editor.timeline)
    contexts = Contexts(
        documents,
        code_files,
        flipbooks,
        BrowserContext.compose(editor),
        CanvasContext.compose(editor, editor.canvas, editor.viewer, documents, code_files),
        CodeContext.compose(editor, editor.code, code_files),
        PaletteContext.compose(editor, editor.canvas, documents),
        CurvesContext.compose(editor, editor.curves),
        DialogContext.compose(editor),
        ExportContext.compose(editor),
        HistoryContext.compose(editor),
        InspectorContext.compose(editor, editor.canvas, editor.viewer, editor.timeline),
        LogContext.compose(editor),
        MatchContext.compose(editor),
        PassesContext.compose(editor),
        PresetContext.compose(editor, editor.viewer),
        PreferencesContext.compose(editor),
        ProblemsContext.compose(editor, editor.canvas),
        RendersContext.compose(editor, editor.timeline, flipbooks),
        StartContext.compose(editor, documents),
        TimelineContext.compose(editor, editor.timeline),
        TutorialContext.compose(editor, editor.canvas, documents),
        ViewerContext.compose(editor, editor.viewer, editor.timeline, editor.canvas, editor.code),
    )
    bind_actions(editor, contexts)
    return contexts


def bind_actions(editor: Editor, contexts: Contexts) -> None:
    """Add all actions, in the order of the menus, each table with what it works on."""
    bind = editor.actions.bind
    bind(DOCUMENTS, contexts.documents)
    bind(EDITS, EditContext.compose(editor, editor.canvas))
    bind(WALKING, contexts.canvas)
    bind(GRAPH, contexts.canvas)
    bind(CODE, contexts.code_files)
    bind(VIEWER, contexts.viewer)
    bind(FLIPBOOK, contexts.flipbooks)
    bind(HANDLES, contexts.viewer)
    bind(SPLINE_ACTIONS, contexts.viewer)
    bind(PLAYBACK, contexts.timeline)
    bind(ANIMATION, contexts.curves)
    bind(TUTORIALS, contexts.tutorials)
    bind(VIEW, ViewSettingsContext.compose(editor))

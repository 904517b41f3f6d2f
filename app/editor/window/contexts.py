"""What each panel, and each group of actions, receives from the editor."""

from __future__ import annotations

from dataclasses import dataclass

from ..actions import ACTION_GROUPS, ActionGroup
from ..actions.context import EditContext, ViewSettingsContext
from ..browser.context import BrowserContext
from ..canvas.context import CanvasContext
from ..code.context import CodeContext
from ..command_palette.context import PaletteContext
from ..curves.context import CurvesContext
from ..dialogs.context import DialogContext
from ..history.context import HistoryContext
from ..inspector.context import InspectorContext
from ..log.context import LogContext
from ..preferences.context import PreferencesContext
from ..problems.context import ProblemsContext
from ..renders.context import RendersContext
from ..start.context import StartContext
from ..timeline.context import TimelineContext
from ..viewer.context import ViewerContext
from ..workflows.code_files import CodeFileWorkflow
from ..workflows.documents import DocumentWorkflow
from ..workflows.flipbook import FlipbookPlayer
from .editor import Editor


@dataclass(frozen=True)
class Contexts:
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
    history: HistoryContext
    inspector: InspectorContext
    log: LogContext
    preferences: PreferencesContext
    problems: ProblemsContext
    renders: RendersContext
    start: StartContext
    timeline: TimelineContext
    viewer: ViewerContext


def compose_contexts(editor: Editor) -> Contexts:
    """Give each panel its collaborators, and bind the actions to theirs."""
    code_files = CodeFileWorkflow(
        editor.session, editor.watcher, editor.dialogs, editor.log, editor.code, editor.commands
    )
    documents = DocumentWorkflow(
        editor.session,
        editor.store,
        editor.watcher,
        editor.recovery,
        editor.exports,
        editor.canvas,
        editor.dialogs,
        editor.log,
        editor.commands,
        code_files,
    )
    flipbooks = FlipbookPlayer(
        editor.stage, editor.viewer, editor.timeline, editor.preview, editor.dialogs, editor.commands
    )
    interface, log = editor.interface, editor.log
    contexts = Contexts(
        documents,
        code_files,
        flipbooks,
        BrowserContext(interface, log, editor.session, editor.store, editor.dialogs),
        CanvasContext(
            interface,
            log,
            editor.session,
            editor.canvas,
            editor.preview,
            editor.store,
            editor.actions,
            editor.dialogs,
            editor.shaders,
            editor.viewer,
            documents,
            code_files,
        ),
        CodeContext(interface, log, editor.session, editor.code, editor.preview, editor.actions, code_files),
        PaletteContext(interface, log, editor.session, editor.actions, editor.canvas, editor.dialogs, documents),
        CurvesContext(interface, log, editor.session, editor.curves, editor.actions, editor.clipboard),
        DialogContext(interface, log, editor.dialogs, editor.actions, editor.clipboard),
        HistoryContext(interface, log, editor.session),
        InspectorContext(
            interface,
            log,
            editor.session,
            editor.preview,
            editor.actions,
            editor.dialogs,
            editor.clipboard,
            editor.canvas,
            editor.viewer,
            editor.timeline,
            editor.renders,
            editor.coloring,
            editor.lights,
        ),
        LogContext(interface, log, editor.clipboard),
        PreferencesContext(
            interface, log, editor.store, editor.actions, editor.dialogs, editor.recovery, editor.clipboard
        ),
        ProblemsContext(
            interface,
            log,
            editor.session,
            editor.preview,
            editor.canvas,
            editor.clipboard,
            editor.recovery,
            editor.watcher,
            editor.store,
            editor.faults,
        ),
        RendersContext(
            interface,
            log,
            editor.session,
            editor.exports,
            editor.store,
            editor.timeline,
            editor.dialogs,
            editor.clipboard,
            editor.coloring,
            flipbooks,
        ),
        StartContext(interface, log, editor.store, editor.dialogs, editor.actions, editor.recovery, documents),
        TimelineContext(interface, log, editor.stage, editor.timeline, editor.preview, editor.actions, editor.lights),
        ViewerContext(
            interface,
            log,
            editor.stage,
            editor.viewer,
            editor.preview,
            editor.display,
            editor.probe,
            editor.store,
            editor.actions,
            editor.dialogs,
            editor.clipboard,
            editor.timeline,
            editor.canvas,
            editor.code,
            editor.renders,
            editor.coloring,
            editor.lights,
        ),
    )
    bind_actions(editor, contexts)
    return contexts


def bind_actions(editor: Editor, contexts: Contexts) -> None:
    """Say what each group of actions works on."""
    by_group: dict[ActionGroup, object] = {
        "documents": contexts.documents,
        "edits": EditContext(editor.session, editor.canvas, editor.clipboard, editor.dialogs),
        "graph": contexts.canvas,
        "code": contexts.code_files,
        "viewer": contexts.viewer,
        "flipbook": contexts.flipbooks,
        "handles": contexts.viewer,
        "playback": contexts.timeline,
        "animation": contexts.curves,
        "view": ViewSettingsContext(editor.store, editor.dialogs, editor.commands),
    }
    for group, context in by_group.items():
        editor.actions.bind(ACTION_GROUPS[group], context)

"""Puts an editor together from its parts."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from imgui_bundle import imgui

from ...authoring.background.render_overviews import RenderOverviews
from ...authoring.log import Log
from ...authoring.preferences import PreferenceStore, state_folder
from ...authoring.preview import Preview
from ...authoring.preview.color_fallback import ColorFallback
from ...authoring.preview.node_timer import NodeTimer
from ...authoring.preview.pass_pictures import PassPictures
from ...authoring.preview.value_strip import ValueStrip
from ...authoring.recovery.recovery import RecoveryFile
from ...authoring.render_queue import RenderQueue
from ...authoring.session import Session
from ...custom_nodes.plugins import is_installed
from ...graph import Graph
from ...inputs.provider import MediaProvider
from ...media.pictures.file_endings import is_picture
from ...renderer import Device, Renderer
from ...renderer.viewing.display import Display
from ...renderer.viewing.probe import PixelProbe
from ...resources.sandbox import Sandbox
from ...watch.watching import FileWatcher
from ..shared.action import Actions
from ..shared.keymaps import KEYMAPS
from ..shared.stage import DocumentStage
from ..toolkit.context import Interface
from .editor import Editor


class SystemClipboard:
    """The clipboard, through the window."""

    def get(self) -> str:
        return imgui.get_clipboard_text() or ""

    def put(self, text: str) -> None:
        imgui.set_clipboard_text(text)


def assemble(device: Device, sandbox: Sandbox, state: Path | None = None) -> Editor:
    """Build an editor on a window's device, with an empty graph. `state` is the folder of everything it remembers."""
    folder = state or state_folder()
    store, log = PreferenceStore(folder), Log()
    renderer = Renderer(device, budget=store.current.memory_budget * 2**20, sandbox=sandbox)
    renders, session = RenderOverviews(sandbox), Session(sandbox=sandbox)
    session.time.measure_frames = lambda graph, bindings: _measure(graph, bindings, sandbox)
    renderer.pictures.describer = renders.describe_render
    display = Display(device)
    return Editor(
        DocumentStage(session),
        Preview(renderer, display),
        store,
        Actions(lambda: store.current.shortcuts, log, lambda: KEYMAPS[store.current.keymap]),
        RecoveryFile(folder, store.current.autosave),
        SystemClipboard(),
        display,
        PixelProbe(device),
        Interface(store),
        RenderQueue(sandbox),
        FileWatcher(sandbox),
        renders,
        ColorFallback(sandbox),
        PassPictures(renderer),
        ValueStrip(renderer, display),
        NodeTimer(renderer),
        log,
    )


def _measure(graph: Graph, bindings: Mapping[str, str], sandbox: Sandbox) -> tuple[int, int]:
    pictures = MediaProvider(sandbox=sandbox)
    return pictures.find_frames(graph, pictures.bind(graph, bindings))


def open_first(editor: Editor, path: Path | None, bindings: Mapping[str, str]) -> None:
    """Show a graph with files bound to its inputs, a picture in a new graph, or the start screen."""
    if path is None:
        editor.dialogs.open.add("start")
        return
    if is_picture(path):
        editor.session.files.open_pictures([path])
        return
    if is_installed(path):
        editor.session.files.open_copy(path)
    else:
        editor.session.files.open(path)
        editor.store.note_opened(path)
    for name, file in bindings.items():
        editor.session.bind(name, file)


def take_apart(editor: Editor) -> None:
    """End what runs, keep what is to be remembered, give back what the device holds."""
    editor.exports.close()
    editor.watcher.close()
    editor.renders.close()
    editor.shaders.close()
    editor.recovery.close(keep=not editor.commands.closing and editor.session.dirty)
    editor.store.flush()
    editor.probe.close()
    editor.strip.close()
    editor.node_timer.stop()
    editor.display.close()
    editor.passes.close()
    editor.preview.close()

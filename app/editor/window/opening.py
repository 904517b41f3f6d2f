"""Opens the window and runs it until it is closed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from imgui_bundle import hello_imgui, immapp

from ..services.preferences import state_folder
from .opengl import best_version
from .window import Window


def open_window(path: Path | None, bindings: Mapping[str, str]) -> None:
    """Run the editor. Raises DeviceError where no window can be opened."""
    state = state_folder()
    window = Window(path, bindings, version=best_version(), state=state)
    window.params.ini_folder_type = hello_imgui.IniFolderType.absolute_path
    window.params.ini_filename = str(state / "layout.ini")
    immapp.run(window.params, immapp.AddOnsParams())
    if window.fault is not None:
        raise window.fault

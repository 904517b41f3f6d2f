"""What plug-ins bring besides nodes and shaders."""

from __future__ import annotations

from pathlib import Path

from halation import presets
from halation.nodes import plugins


def preset_paths() -> tuple[Path, ...]:
    """Every preset: those of Halation, then those that plug-ins have in their folder `presets`."""
    folders = (plugin.folder / "presets" for plugin in plugins() if plugin.folder and not plugin.fault)
    return (*presets.paths(), *(path for folder in folders for path in sorted(folder.glob("*.json"))))

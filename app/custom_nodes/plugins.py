"""Presets by name: those of Halation, of the user's folders and of plug-ins."""

from __future__ import annotations

import os
from pathlib import Path

from halation import presets
from halation.nodes import Plugin, plugins

from ..errors import DocumentError
from ..resources.user_folders import list_preset_folders


def preset_paths() -> tuple[Path, ...]:
    """Every preset: those of Halation, of the user's folders, then those that plug-ins have in their `presets`."""
    return tuple(name_presets().values())


def name_presets() -> dict[str, Path]:
    """Every preset by its name: `soft_bloom`, or `acme_glow.dream` for one of a plug-in."""
    loaded = {plugin.namespace: plugin.folder / "presets" for plugin in plugins() if plugin.folder and not plugin.fault}
    names = {path.stem: path for path in presets.paths()}
    names |= {name: path for name, path in name_library().items() if name not in names}
    for namespace, folder in loaded.items():
        names |= {f"{namespace}.{path.stem}": path for path in sorted(folder.glob("*.json"))}
    return names


def name_library() -> dict[str, Path]:
    """The graphs in the user's folders by name; in the first folder that has the name, if several have it."""
    names: dict[str, Path] = {}
    for folder in list_preset_folders():
        for path in sorted(folder.glob("*.json")):
            names.setdefault(path.stem, path)
    return names


def find_preset(name: str) -> Path | None:
    """The file of a preset, or None. Plug-ins are imported only for names that have a namespace."""
    if "." in name:
        return name_presets().get(name)
    return next((path for path in presets.paths() if path.stem == name), None) or name_library().get(name)


def is_installed(preset: Path) -> bool:
    """True for a preset of Halation or of a plug-in whose folder is an installation, which an update replaces.

    In a checkout, which has a pyproject.toml above, presets are files to work on. Those of the user are too.
    """
    path = preset.resolve()
    folders = [presets.sample().parents[1], *(plugin.folder / "presets" for plugin in plugins() if plugin.folder)]
    in_checkout = any((folder / "pyproject.toml").is_file() for folder in path.parents)
    return not in_checkout and path.parent in {folder.resolve() for folder in folders}


def find_refused_plugin(name: str) -> Plugin | None:
    """The plug-in that cannot be loaded and would bring what a name with a namespace stands for: a node or a preset."""
    if "." not in name:
        return None
    namespace = name.partition(".")[0]
    return next((plugin for plugin in plugins() if plugin.fault and plugin.namespace == namespace), None)


def find_graph_or_preset(name: str | Path) -> Path:
    """The path that the user named, or the file of a preset if there is no such file and a preset has this name.

    A folder is no graph, so one that has the name of a preset does not hide it. Raises DocumentError for the name of a
    preset whose plug-in cannot be loaded.
    """
    path = Path(name)
    if path.name != str(name) or (os.path.lexists(path) and not path.is_dir()):
        return path
    if preset := find_preset(path.name):
        return preset
    if plugin := find_refused_plugin(path.name):
        fault = f"there is no such file, and the plug-in {plugin} cannot be loaded: {plugin.fault}"
        raise DocumentError(str(name), "", fault, rule="unreadable-graph")
    return path

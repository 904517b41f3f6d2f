"""Folders of the user: the editor's own files, and presets."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import cast

STATE_VARIABLE = "HALATION_STATE"
"""The environment variable that names the folder of everything that the editor keeps."""

PRESETS_VARIABLE = "HALATION_PATH"
"""The environment variable with more folders of presets, separated as in PATH."""

PREFERENCES = "preferences.json"


def state_folder() -> Path:
    """The folder of preferences and recovered work: HALATION_STATE, else the system's folder for settings."""
    import platformdirs

    folder = os.environ.get(STATE_VARIABLE)
    return Path(folder).absolute() if folder else platformdirs.user_state_path("halation", appauthor=False)


def own_presets_folder() -> Path:
    """The folder of the user's own presets: `presets` in HALATION_STATE, else in the system's folder for data."""
    import platformdirs

    folder = os.environ.get(STATE_VARIABLE)
    base = Path(folder).absolute() if folder else platformdirs.user_data_path("halation", appauthor=False)
    return base / "presets"


def first_folder() -> Path:
    """Where to look for files when nothing is known yet: the folder in which the program was started.

    Home where that says nothing, as for a program that was started from a menu of the system.
    """
    try:
        here = Path.cwd()
    except OSError:  # it was removed since
        return Path.home()
    return Path.home() if here == Path(here.anchor) else here


def find_desktop_folder() -> Path:
    """The user's folder of what programs of the desktop share, such as icons and entries of the menu."""
    import platformdirs

    return platformdirs.user_data_path()


def list_preset_folders() -> tuple[Path, ...]:
    """Folders whose graphs are presets: the user's own, those of the preferences, then those of HALATION_PATH."""
    listed = os.environ.get(PRESETS_VARIABLE, "").split(os.pathsep)
    shared = (*_read_shared_folders(), *listed)
    return tuple(dict.fromkeys((own_presets_folder(), *(Path(folder).absolute() for folder in shared if folder))))


def _read_shared_folders() -> tuple[str, ...]:
    """The folders of presets in the preferences; none where the file is missing or damaged, which the editor says."""
    try:
        preferences = json.loads((state_folder() / PREFERENCES).read_bytes())
        folders = preferences["preset_folders"]
    except (OSError, ValueError, KeyError, TypeError):
        return ()
    listed = cast("list[object]", folders) if isinstance(folders, list) else []
    return tuple(folder for folder in listed if isinstance(folder, str))

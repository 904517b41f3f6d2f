"""Writes what no command line writes: `python saving.py cache|preferences|recovery|session` in the folder of a case.

All goes into `home` below the current folder, but what the session saves, which is the graph of the case.
"""

from __future__ import annotations

import sys
from pathlib import Path

from halation import document
from halation.authoring.commands import SetValue
from halation.authoring.preferences import PreferenceStore
from halation.authoring.recovery.recovery import RecoveryFile
from halation.authoring.session.session import Session
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED

HOME = Path("home")


def save_cache() -> None:
    """The times of the device, measured anew."""
    from halation.renderer.calibration import load_or_measure
    from halation.renderer.opening import open_device

    device = open_device("fragment", sandbox=UNRESTRICTED)
    with device.make_current():
        for folder in (HOME / "one", HOME / "two"):
            assert load_or_measure(device, folder, sandbox=UNRESTRICTED)


def save_preferences() -> None:
    """Three changes of preferences; what was written is read back."""
    for theme, autosave in (("dark", 1.0), ("light", 2.0), ("dark", 3.0)):
        store = PreferenceStore(HOME)
        assert not store.faults, store.faults
        store.change(theme=theme, autosave=autosave)
        store.note_opened("graph.json")
        store.flush()


def save_recovery() -> None:
    """Unsaved work of two editors; what they leave behind can be read."""
    for _ in range(2):
        recovery = RecoveryFile(HOME, 0.0)
        for abandoned in recovery.find_abandoned():
            abandoned.load(UNRESTRICTED)
        recovery.note(document.load("graph.json", sandbox=UNRESTRICTED), Path("messy.json"), dirty=True)
        recovery.close(keep=True)


def save_session() -> None:
    """Edits and saves of a document, under its own name and a new one."""
    session = Session(sandbox=UNRESTRICTED)
    session.files.open("graph.json")
    for number in range(3):
        session.apply(SetValue(Port("n", "size"), 10.0 + number))
        session.files.save()
    session.files.save_as("copy.json")


if __name__ == "__main__":
    {"cache": save_cache, "preferences": save_preferences, "recovery": save_recovery, "session": save_session}[
        sys.argv[1]
    ]()

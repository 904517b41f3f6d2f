"""The whole editor, killed at any moment: the last save is whole, unsaved work is offered again, as new as promised."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import pytest
from halation import document, presets
from halation.authoring.recovery.recovery import RecoveryFile
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED

LOOK = next(path for path in presets.paths() if path.stem == "agx_look")
STOPS, AUTOSAVE = Port("tone", "exposure"), 0.5

EDITING = """
import sys, time
from halation.editor.window.frame_updater import FrameUpdater
from halation.authoring.commands import SetValue
from halation.graph import Port

update, count = FrameUpdater.update, 0

def edited(self):
    global count
    editor = self._editor
    count += 1
    editor.recovery.interval = 0.5
    editor.session.apply(SetValue(Port("tone", "exposure"), count / 1024))
    print("edited", count, time.time(), flush=True)
    if count % 7 == 0:
        editor.actions.run("file.save")
        assert not editor.session.dirty, [entry.sentence for entry in editor.log.entries]
        print("saved", count, time.time(), flush=True)
        editor.session.apply(SetValue(Port("tone", "exposure"), (count + 0.5) / 1024))
    update(self)

FrameUpdater.update = edited
from halation.cli.program import run
sys.exit(run(["edit", sys.argv[1]]))
"""


@dataclass
class Killed:
    """What an editor said until it was killed, and when that was."""

    edited: dict[int, float]
    saved: int
    ended: float


def killed(path: Path, state: Path, delay: float) -> Killed:
    """Run an editor that edits in every frame and saves in some; kill it `delay` seconds after its first edit."""
    place = {**os.environ, "HALATION_STATE": str(state), "HALATION_WINDOW": "none"}
    words = [sys.executable, "-c", EDITING, str(path)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, env=place, text=True) as process:
        assert process.stdout is not None
        first = process.stdout.readline()
        time.sleep(delay)
        process.kill()
        ended = time.time()
        lines = [first, *process.stdout.readlines()]
    said = [line.split() for line in lines if line.endswith("\n")]
    edited = {int(count): float(when) for word, count, when in said if word == "edited"}
    return Killed(edited, max((int(count) for word, count, _ in said if word == "saved"), default=0), ended)


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_killed_while_editing_and_saving(tmp_path: Path, is_nightly: bool) -> None:
    rounds = 100 if is_nightly else 5
    path, state, chance = tmp_path / "look.json", tmp_path / "state", random.Random(4)
    shutil.copy(LOOK, path)
    offered = 0
    for round in range(rounds):
        one = killed(path, state, chance.uniform(0.0, 0.4) if round % 5 else chance.uniform(1.2, 1.8))
        there = document.load(path, sandbox=UNRESTRICTED).value(STOPS) * 1024
        assert not one.saved or one.saved <= there <= one.saved + 7, "the last save is whole"
        after = RecoveryFile(state)
        for found in after.find_abandoned():
            offered += 1
            assert found.path == path
            number = int(found.load(UNRESTRICTED).value(STOPS) * 1024)
            newer = [when for count, when in one.edited.items() if count > number]
            assert all(when > one.ended - AUTOSAVE - 1.0 for when in newer), "it is as new as promised"
            found.discard()
        after.close()
        assert not list((state / "recovery").iterdir())
    assert offered >= rounds // 5

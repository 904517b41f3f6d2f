"""Someone who knows nothing of the editor plays with it: nothing fails, and the document can still be saved.

HALATION_ACTS=1000 plays longer, HALATION_SEEDS=20 more often.
"""

from __future__ import annotations

import os
import shutil

import pytest
from gui_player import SIZE, Player
from halation import document, presets
from halation.resources.sandbox import UNRESTRICTED


@pytest.mark.parametrize("seed", range(1, 1 + int(os.environ.get("HALATION_SEEDS", "2"))))
def test_nothing_that_is_done_at_random_fails(gui, tmp_path, monkeypatch, seed: int) -> None:
    source = presets.paths()[seed % len(presets.paths())]
    shutil.copytree(source.parent / "samples", tmp_path / "samples")
    path = tmp_path / "played.json"
    shutil.copy(source, path)
    monkeypatch.chdir(tmp_path)

    def body(ui) -> None:
        player = Player(ui, seed)
        for _ in range(int(os.environ.get("HALATION_ACTS", "30"))):
            player.act()
            assert not ui.editor.faults, ui.editor.faults
        kept = tmp_path / "kept.json"
        ui.session.files.save_as(kept)
        assert document.load(kept, sandbox=UNRESTRICTED) == ui.session.root

    gui(body, path, size=SIZE)

"""The viewer reads no more of a large file than it shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gui_driver import Ui
from halation.authoring.preview import large_files
from halation.compiler.lowering import pictures
from oiio_pictures import write_with_attributes


def test_a_large_file_is_as_fine_as_it_is_seen(gui, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (large_files, pictures):
        monkeypatch.setattr(module, "LARGE_PICTURE", 100 * 200)
    path = write_with_attributes(tmp_path / "plate.exr", np.full((100, 200, 4), 0.5, np.float32))

    def body(ui: Ui) -> None:
        def show_at(zoom: float) -> tuple[float, tuple[int, int]]:
            ui.editor.viewer.zoom = zoom
            ui.wait(3)
            ui.settled()
            image = ui.editor.preview.find_whole_image("A")
            assert image is not None and image.full_size == (200, 100)
            return image.scale, image.texture.size

        assert show_at(0.1) == (0.125, (25, 12))
        assert show_at(0.3) == (0.5, (100, 50))
        assert show_at(1.0) == (1.0, (200, 100))
        assert show_at(0.2) == (0.25, (50, 25))

    gui(body, Path(path))

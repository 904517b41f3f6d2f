"""An anamorphic picture is shown as wide as it is meant, or with square pixels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gui_viewer import inside, seen
from halation import document, media
from halation.editor.viewer.geometry import Sight
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED

WIDTH, HEIGHT = 60, 50


def test_the_shape_of_pixels_can_be_switched(gui, tmp_path: Path) -> None:
    pixels = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    pixels[:, WIDTH // 2 :] = 1.0
    path = tmp_path / "a.exr"
    kinds, ratio = {"image": Kind.IMAGE}, {"PixelAspectRatio": 2.0}
    media.write_picture(path, {"image": pixels}, kinds=kinds, metadata=ratio, sandbox=UNRESTRICTED)
    graph = Graph().add_input("picture", Input(Kind.IMAGE, file="a.exr")).add_output("image", Output())
    document.save(
        graph.connect(Port("inputs", "picture"), Port("outputs", "image")), tmp_path / "g.json", sandbox=UNRESTRICTED
    )

    def measure(ui) -> tuple[float, float]:
        ui.settled()
        left, top, right, bottom = ui.editor.places["viewer image"]
        return right - left, bottom - top

    def body(ui) -> None:
        viewer = ui.editor.viewer
        width, height = measure(ui)
        assert width / height == pytest.approx(2.0 * WIDTH / HEIGHT, rel=0.01)
        assert width <= viewer.panel[0] and height <= viewer.panel[1]
        assert seen(ui, 0.45, 0.5)[0] < 30 and seen(ui, 0.55, 0.5)[0] > 150
        sight = Sight.of((0.0, 0.0), viewer.panel, (WIDTH, HEIGHT), 0.0, (0.0, 0.0), 1.0, 2.0)
        assert sight.pixel(sight.screen((13.0, 21.0))) == pytest.approx((13.0, 21.0))
        ui.move(inside(ui, 0.51, 0.51))
        ui.wait(3)
        assert viewer.pixel == (WIDTH // 2, HEIGHT // 2)
        ui.click("button viewer.unsqueeze")
        width, height = measure(ui)
        assert width / height == pytest.approx(WIDTH / HEIGHT, rel=0.01) and not ui.session.dirty

    gui(body, tmp_path / "g.json")

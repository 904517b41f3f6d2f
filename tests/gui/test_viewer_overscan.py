"""The viewer shows what a picture has beyond its frame, dimmed, and measures the frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from exr_files import write_exr
from gui_viewer import inside, seen
from halation import document
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.resources.sandbox import UNRESTRICTED

SIZE = (120, 80)
GRAY = 0.5


def write_graph(path: Path, overscan: float) -> None:
    """A gray picture that is moved out of its frame by a quarter of its width, to the right."""
    pixels = np.full((SIZE[1], SIZE[0], 4), GRAY, np.float32)
    pixels[..., 3] = 1.0
    write_exr(path.parent / "gray.exr", {"beauty": pixels}, {"beauty": "float"})
    graph = Graph(settings=Settings(overscan=overscan)).add_output("image", Output(Kind.IMAGE))
    graph = graph.add_input("gray", Input(Kind.IMAGE, file="gray.exr"))
    graph = graph.add("moved", catalogue()["transform"](position=(SIZE[0] / 4, 0.0), kernel="nearest"))
    graph = graph.connect(Port("inputs", "gray"), Port("moved", "image"))
    graph = graph.connect(Port("moved", "out"), Port("outputs", "image"))
    document.save(graph, path, sandbox=UNRESTRICTED)


@pytest.mark.parametrize("overscan", [0.5, 0.0])
def test_what_was_moved_out_of_the_frame_is_dimmed(gui, tmp_path: Path, overscan: float) -> None:
    write_graph(tmp_path / "graph.json", overscan)

    def body(ui) -> None:
        ui.settled()
        viewer, places = ui.editor.viewer, ui.editor.places
        viewer.background = "black"
        fitted = places["viewer image"]
        viewer.zoom = 1.0
        ui.settled()
        frame, beyond, void = (seen(ui, x, 0.3) for x in (0.9, 1.1, 1.4))
        image = ui.editor.preview.find_whole_image("A")
        assert (image.size, image.full_size, image.partial) == (SIZE, SIZE, False)
        assert image.reaches_beyond == (overscan > 0.0)
        if not overscan:
            assert "viewer frame" not in places and (beyond == void).all()
            assert "button viewer.overscan" not in places
            return
        assert places["viewer frame"] == places["viewer image"]
        np.testing.assert_allclose(beyond, 0.35 * frame, atol=2)
        assert image.start[0] == 0 and image.texture.size[0] > SIZE[0]
        assert ui.ask(lambda: viewer.reader.read_small(ui.editor.probe, image)).shape[:2] == (SIZE[1], SIZE[0])
        viewer.fit()
        ui.settled()
        assert places["viewer image"] == fitted  # the frame fills the panel, whatever lies around it
        viewer.zoom = 1.0
        ui.click("button viewer.overscan")
        ui.settled()
        assert not ui.editor.preview.find_whole_image("A").reaches_beyond and not ui.session.dirty
        assert (seen(ui, 1.1, 0.3) == void).all() and inside(ui, 0.0, 0.0) == places["viewer image"][:2]

    gui(body, tmp_path / "graph.json")

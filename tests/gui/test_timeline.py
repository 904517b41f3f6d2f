"""Time in the real window: scrubbing, playing, keys of values, frames that are ready, histories."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.app.graph import Graph, Keys, Output, Port, Settings
from halation.app.renderer import Reel, Wanted
from halation.nodes import catalogue

NODES = catalogue()
OUT = Port("outputs", "image")


def shot(folder: Path, frames: range = range(1, 13), size: tuple[int, int] = (64, 36)) -> str:
    """A bar that moves to the right, over a ramp; the pattern of its files."""
    width, height = size
    for frame in frames:
        picture = np.zeros((height, width, 4), np.float32)
        picture[..., :3] = np.linspace(0.02, 0.3, width)[None, :, None]
        left = (frame - frames[0]) * width // len(frames)
        picture[:, left : left + max(width // 12, 2), :3] = (1.0, 0.55, 0.2)
        picture[..., 3] = 1.0
        image = oiio.ImageBuf(oiio.ImageSpec(width, height, 4, "half"))
        image.set_pixels(oiio.ROI(0, width, 0, height, 0, 1, 0, 4), picture)
        assert image.write(str(folder / f"bar.{frame:04d}.exr"))
    return str(folder / "bar.####.exr")


def graph_of(path: str, *nodes: str, **settings: object) -> Graph:
    """A sequence through some nodes."""
    graph = Graph(outputs={"image": Output()}, settings=Settings(**settings))
    graph = graph.add("read", NODES["read_image"](path=path))
    last = Port("read", "out")
    for id in nodes:
        graph = graph.add(id, NODES[id]())
        face = NODES[id].inputs
        graph = graph.connect(last, Port(id, next(iter(face))))
        last = Port(id, next(iter(NODES[id].outputs)))
    return graph.connect(last, OUT)


def start(ui, graph: Graph) -> None:
    ui.editor.dialogs.open.clear()
    ui.session.edit("Start", graph)
    ui.session.seal()
    ui.session.select([])
    ui.settled()


def seen(ui) -> np.ndarray:
    shown = ui.editor.preview.shown("A")
    width, height = shown.texture.size
    return ui.ask(lambda: ui.editor.probe.region(shown.texture, (0, 0, width, height)))


def test_scrubbing_shows_other_frames(gui, tmp_path) -> None:
    path = shot(tmp_path)

    def body(ui) -> None:
        start(ui, graph_of(path, "exposure"))
        assert ui.session.frames == (1, 12) and ui.session.frame == 1
        first = seen(ui)
        ui.shot("timeline.png")
        ui.drag("ruler 1", "ruler 12")
        assert ui.session.frame == 12
        ui.settled()
        assert not np.array_equal(seen(ui), first)
        steps = len(ui.session.history.steps)
        ui.drag("ruler 12", "ruler 1")
        ui.settled()
        np.testing.assert_array_equal(seen(ui), first)
        assert len(ui.session.history.steps) == steps, "the frame is no part of the document"
        assert {1, 12} <= set(ui.editor.preview.frames)

    gui(body)

"""Time speed: which frame is seen when, against the formula, and dissolves against numpy."""

from __future__ import annotations

import numpy as np
import pytest
from exr_files import write_exr
from halation.graph import Graph, Key, Keys, Output, Port, Settings
from halation.nodes.input.read_image import ReadImage
from halation.nodes.time.time_speed import TimeSpeed
from halation.renderer import RenderRequest
from sequences import node_at, noise_at, noise_graph


@pytest.mark.parametrize(
    ("values", "seen"),
    [
        ({"speed": 2.0}, [1, 3, 5, 7, 9]),
        ({"speed": -1.0, "pivot": 3}, [5, 4, 3, 2, 1]),
        ({"speed": 0.5}, [1, 2, 2, 3, 3]),
        ({"speed": 0.1, "pivot": -9}, [-8, -8, -8, -8, -8]),
        ({"speed": 0.0, "pivot": 4}, [4, 4, 4, 4, 4]),
        ({"mode": "source", "source": 6.4}, [6, 6, 6, 6, 6]),
    ],
)
def test_which_frame_is_seen(renderer, values, seen):
    graph = noise_graph(TimeSpeed(**values))
    for frame, source in enumerate(seen, 1):
        assert np.array_equal(node_at(renderer, graph, frame), noise_at(renderer, graph, source)), frame


@pytest.mark.parametrize("speed", [0.5, 0.3, -0.7, 1.25])
def test_frames_dissolve_in_linear_light(renderer, speed):
    graph = noise_graph(TimeSpeed(speed=speed, pivot=2, between="blend"))
    for frame in range(1, 7):
        seen = 2 + speed * (frame - 2)
        whole = int(np.floor(seen + 1e-9))
        expected = noise_at(renderer, graph, whole) * (1 - (seen - whole))
        expected += noise_at(renderer, graph, whole + 1) * (seen - whole)
        assert np.abs(node_at(renderer, graph, frame) - expected).max() < 1e-6


def test_keys_remap_time(renderer):
    """In at frame 1, out at frame 9: there and back."""
    graph = noise_graph(TimeSpeed(mode="source"))
    keys = Keys((Key(1, 1.0, "linear"), Key(5, 9.0, "linear"), Key(9, 1.0, "linear")))
    graph = graph.animate(Port("node", "source"), keys)
    for frame, source in zip(range(1, 10), (1, 3, 5, 7, 9, 7, 5, 3, 1), strict=True):
        assert np.array_equal(node_at(renderer, graph, frame), noise_at(renderer, graph, source))


def test_data_is_never_mixed(renderer, tmp_path):
    for frame in (1, 2):
        write_exr(tmp_path / f"id.{frame:04}.exr", {"id": np.full((2, 3, 1), 5.0 * frame, np.float32)}, {"id": "float"})
    graph = Graph(settings=Settings(frames=(1, 2))).add("read", ReadImage(path=str(tmp_path / "id.####.exr")))
    graph = graph.add("node", TimeSpeed(mode="source", source=1.4, between="blend"))
    for socket, read in (("field", "field"), ("image", "out")):
        graph = graph.connect(Port("read", read), Port("node", socket))
    graph = graph.add_output("id", Output()).connect(Port("node", "field_out"), Port("outputs", "id"))
    assert (renderer.render(graph, RenderRequest())["id"][..., 0] == 5.0).all()


def test_a_dissolve_holds_no_nan(renderer, tmp_path):
    for frame, value in ((1, np.nan), (2, np.inf)):
        picture = np.full((2, 3, 4), value, np.float32)
        write_exr(tmp_path / f"shot.{frame:04}.exr", {"it": picture}, {"it": "float"})
    graph = Graph(settings=Settings(frames=(1, 2))).add("read", ReadImage(path=str(tmp_path / "shot.####.exr")))
    graph = graph.add("node", TimeSpeed(mode="source", source=1.5, between="blend"))
    graph = graph.connect(Port("read", "out"), Port("node", "image"))
    graph = graph.add_output("out", Output()).connect(Port("node", "out"), Port("outputs", "out"))
    assert np.isfinite(node_at(renderer, graph, 1)).all()

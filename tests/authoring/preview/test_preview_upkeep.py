"""Beside the pictures: times, memory, thumbnails."""

from __future__ import annotations

import numpy as np
from device_textures import read_texture
from halation.graph import Graph, Input, Output, Port, Settings
from halation.nodes import Kind, catalogue
from halation.nodes.color.exposure import Exposure
from previews import INPUTS, OUT, PICTURE, chain, count_passes, render_port, request_preview, settle

# --- upkeep ----------------------------------------------------------------------------------------------------------


def test_times_of_nodes(preview, engine):
    graph = chain().add("more", Exposure(stops=1.0)).connect(Port("color", "out"), Port("more", "image"))
    graph = graph.connect(Port("more", "out"), Port("outputs", "image"))
    request_preview(preview, graph)
    settle(preview)
    assert preview.timings == {}
    preview.timed = True
    preview.clear()
    settle(preview)
    timings = dict(preview.timings)
    assert set(timings) == {"light", "blur", "color", "more"}
    assert all(item.seconds > 0.0 for item in timings.values())
    assert timings["color"].shared == ("more",) and timings["blur"].shared == ()
    assert timings["color"].bytes == timings["light"].bytes == PICTURE.nbytes
    assert timings["blur"].bytes == 2 * PICTURE.nbytes
    request_preview(preview, graph.set(Port("more", "stops"), 2.0))
    settle(preview)
    assert preview.timings["light"] == timings["light"] and preview.timings["more"] != timings["more"]


def test_clearing_computes_all_anew(preview, engine):
    request_preview(preview, chain())
    settle(preview)
    before = count_passes(engine)
    assert preview.memory[0] > PICTURE.nbytes
    preview.clear()
    assert preview.memory[0] == 0 and preview.find_whole_image("A") is None and preview.busy
    settle(preview)
    assert count_passes(engine) == 2 * before and preview.find_whole_image("A") is not None


def test_closing_leaves_no_lease(preview, engine):
    request_preview(preview, chain())
    preview.work(0.0)
    preview.close()
    assert not engine.runner.textures._leases and not preview.busy


# --- thumbnails ------------------------------------------------------------------------------------------------------


def test_thumbnails_of_what_is_there(preview, engine):
    request_preview(preview, chain())
    settle(preview)
    before = count_passes(engine)
    for path in ("inputs.image", "light", "blur", "color"):
        texture, fresh = preview.thumbnail(path)
        assert texture.size == (37, 23) and fresh
    assert preview.thumbnail("nobody") is None and count_passes(engine) == before
    light = np.clip(render_port(engine, chain(), Port("light", "out")), 0.0, 1.0)
    drawn = read_texture(engine.device, preview.thumbnail("light")[0], np.uint8)[..., :3]
    opaque = PICTURE[..., 3] > 0.9
    assert np.corrcoef(drawn[opaque].ravel(), light[opaque][..., :3].ravel())[0, 1] > 0.8


def test_a_large_picture_has_a_small_thumbnail(preview):
    request_preview(
        preview, chain(), {"A": Port("inputs", "image")}, bindings={"image": np.ones((300, 640, 4), np.float32)}
    )
    settle(preview)
    assert preview.thumbnail("inputs.image")[0].size == (160, 75)


def test_a_thumbnail_grows_stale_and_fresh_again(preview):
    request_preview(preview, chain())
    settle(preview)
    request_preview(preview, chain(saturation=0.9))
    assert preview.thumbnail("blur")[1] and not preview.thumbnail("color")[1]
    settle(preview)
    assert preview.thumbnail("color")[1]
    request_preview(preview, chain(saturation=0.9), {"A": Port("light", "out")})
    settle(preview)
    request_preview(preview, chain(sigma=5.0, saturation=0.9), {"A": Port("light", "out")})
    settle(preview)
    assert preview.thumbnail("light")[1] and not preview.thumbnail("color")[1]
    request_preview(preview, chain(saturation=0.9), {"A": Port("light", "out")})
    assert preview.thumbnail("color")[1]


def test_a_view_of_a_later_output_keeps_the_thumbnail_of_an_earlier_one(preview, engine):
    """A node is known by its first output, such as the color of a render, until something upstream of it changes."""
    graph = Graph().add("split", catalogue()["separate"]()).add_input("image", Input(Kind.IMAGE))
    graph = graph.connect(Port("inputs", "image"), Port("split", "image"))
    places = list(catalogue()["separate"].outputs)
    request_preview(preview, graph, {"A": Port("split", places[0])})
    settle(preview)

    def read_thumbnail():
        return read_texture(engine.device, preview.thumbnail("split")[0], np.uint8)

    first = read_thumbnail()
    request_preview(preview, graph, {"A": Port("split", places[1])})
    settle(preview)
    assert np.array_equal(read_thumbnail(), first)
    changed = graph.add("light", Exposure(stops=1.0)).connect(Port("inputs", "image"), Port("light", "image"))
    changed = changed.connect(Port("light", "out"), Port("split", "image"))
    request_preview(preview, changed, {"A": Port("split", places[1])})
    settle(preview)
    assert preview.thumbnail("split")[1] and not np.array_equal(read_thumbnail(), first)


def test_thumbnails_can_be_off(preview, engine):
    preview.thumbnailing = False
    request_preview(preview, chain())
    settle(preview)
    assert preview.thumbnail("color") is None


def test_a_thumbnail_of_depth_shows_its_range(preview, engine):
    depth = np.linspace(100.0, 900.0, 37 * 23, dtype=np.float32).reshape(23, 37, 1)
    graph = Graph(inputs={"depth": Input(Kind.FIELD)})
    request_preview(preview, graph, {"A": Port("inputs", "depth")}, bindings={"depth": depth})
    settle(preview)
    drawn = read_texture(engine.device, preview.thumbnail("inputs.depth")[0], np.uint8)
    assert drawn[0, 0, 0] == 0 and drawn[-1, -1, 0] == 255 and 100 < drawn[11, 18, 0] < 155


def test_the_sky_does_not_make_a_thumbnail_of_depth_black(preview, engine):
    depth = np.linspace(2.0, 9.0, 37 * 23, dtype=np.float32).reshape(23, 37, 1)
    depth[:5] = 1e10
    request_preview(
        preview, Graph(inputs={"depth": Input(Kind.FIELD)}), {"A": Port("inputs", "depth")}, bindings={"depth": depth}
    )
    settle(preview)
    drawn = read_texture(engine.device, preview.thumbnail("inputs.depth")[0], np.uint8)
    assert drawn[2, 3, 0] == 255 and drawn[5, 0, 0] < 10 and 100 < drawn[14, 18, 0] < 155


# --- beyond the frame ------------------------------------------------------------------------------------------------


def make_moved() -> Graph:
    """The picture, 10 pixels to the left and 5 up, in a graph that keeps what leaves the frame."""
    graph = Graph(inputs={"image": Input(Kind.IMAGE)}, outputs={"image": Output()}, settings=Settings(overscan=1.0))
    graph = graph.add("moved", catalogue()["transform"](position=(-10.0, -5.0), kernel="nearest"))
    graph = graph.connect(Port("inputs", "image"), Port("moved", "image"))
    return graph.connect(Port("moved", "out"), Port("outputs", "image"))


def test_what_lies_beyond_the_frame_is_there_if_a_panel_shows_it(preview, engine):
    height, width = PICTURE.shape[:2]
    preview.want(make_moved(), OUT, bindings=INPUTS, whole=frozenset("A"))
    settle(preview)
    shown = preview.find_whole_image("A")
    assert shown.reaches_beyond and not shown.partial and shown.size == shown.full_size == (width, height)
    (x, y), made = shown.start, read_texture(engine.device, shown.texture)
    assert x <= -10 and y <= -5
    np.testing.assert_array_equal(made[-5 - y : -5 - y + height, -10 - x : -10 - x + width], PICTURE)
    assert made[-5 - y + height :].max() == 0.0 and made[:, -10 - x + width :].max() == 0.0
    left, top, *size = shown.part
    assert (left, top, *size) == (-x, -y, width, height)
    preview.want(make_moved(), OUT, bindings=INPUTS)
    settle(preview)
    assert preview.find_whole_image("A").texture.size == (width, height)


def test_a_thumbnail_shows_the_frame(preview, engine):
    """A white square of the whole frame, half of it moved out: the thumbnail is half black."""
    graph = make_moved().set(Port("moved", "position"), (PICTURE.shape[1] / 2 + 0.5, 0.0))
    white = np.ones_like(PICTURE)
    preview.want(graph, OUT, bindings={"image": white}, whole=frozenset("A"))
    settle(preview)
    texture, _ = preview.thumbnail("moved")
    made = read_texture(engine.device, texture, np.uint8)[..., 0]
    assert made.shape == PICTURE.shape[:2]
    assert made[:, 20:].min() > 250 and made[:, :18].max() < 128

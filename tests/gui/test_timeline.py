"""Time in the real window: scrubbing, playing, keys of values, frames that are ready, histories."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from halation.authoring.commands import ReplaceGraph, SetValue
from halation.authoring.edits.element_id import ElementId
from halation.editor.window.dropped_files import take_files
from halation.graph import Expression, Graph, Output, Port, Settings
from halation.nodes import catalogue
from halation.renderer import FrameRenderer, RenderRequest

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
    ui.session.apply(ReplaceGraph("Start", graph))
    ui.session.seal()
    ui.session.select([])
    ui.settled()


def seen(ui) -> np.ndarray:
    shown = ui.editor.preview.find_whole_image("A")
    width, height = shown.texture.size
    return ui.ask(lambda: ui.editor.probe.read_region(shown.texture, (0, 0, width, height)))


def test_scrubbing_shows_other_frames(gui, tmp_path) -> None:
    path = shot(tmp_path)

    def body(ui) -> None:
        start(ui, graph_of(path, "exposure"))
        assert ui.session.time.frames == (1, 12) and ui.session.time.frame == 1
        first = seen(ui)
        ui.shot("timeline.png")
        ui.drag("ruler 1", "ruler 12")
        assert ui.session.time.frame == 12
        ui.settled()
        assert not np.array_equal(seen(ui), first)
        steps = len(ui.session.history.steps)
        ui.drag("ruler 12", "ruler 1")
        ui.settled()
        np.testing.assert_array_equal(seen(ui), first)
        assert len(ui.session.history.steps) == steps, "the frame is no part of the document"
        assert {1, 12} <= set(ui.editor.preview.frames)

    gui(body)


def test_playing_goes_on_loops_and_stops(gui, tmp_path) -> None:
    path = shot(tmp_path)

    def body(ui) -> None:
        start(ui, graph_of(path, "exposure", frames=(1, 12), rate=24.0))
        timeline, frames = ui.editor.timeline, []
        ui.move("Viewer")
        ui.keys("Space")
        assert timeline.playback.playing and not ui.window.params.fps_idling.enable_idling
        shown = set()

        def looped() -> bool:
            frames.append(ui.session.time.frame)
            shown.add(ui.editor.preview.find_whole_image("A").frame)
            return any(after < before for before, after in pairwise(frames)) and len(shown) > 3

        ui.until(looped)
        ui.shot("playing.png")
        ui.until(lambda: set(ui.editor.preview.frames) == set(range(1, 13)), 60.0)
        ui.wait(20)
        assert "of 24 fps" in timeline.playback.words and timeline.playback.rate > 1.0
        ui.keys("Space")
        assert not timeline.playback.playing and timeline.report
        ui.settled()
        ui.until(lambda: ui.window.params.fps_idling.enable_idling)
        here = ui.session.time.frame
        ui.keys("RightArrow")
        assert ui.session.time.frame == here % 12 + 1
        ui.keys("Shift+LeftArrow")
        assert ui.session.time.frame == 1
        ui.keys("LeftArrow")
        assert ui.session.time.frame == 12, "round the corner"
        ui.settled()
        ui.shot("ready.png")

        ui.click("button time.loops")
        assert timeline.loop == "once"
        ui.keys("Shift+LeftArrow")
        ui.click("button time.play")
        ui.until(lambda: not timeline.playback.playing)
        assert ui.session.time.frame == 12

        ui.drag("ruler in", ui.at("ruler", (0.34, 0.1)))
        assert timeline.part is not None and timeline.part[1] == 12 and timeline.span(ui.session)[0] > 3
        ui.keys("Shift+LeftArrow")
        assert ui.session.time.frame == timeline.part[0]
        ui.shot("part.png")

        ui.click("field timeline frame")
        ui.type("7")
        assert ui.session.time.frame == 7
        ui.move("ruler")
        ui.wheel(4.0)
        low, high = timeline.view
        assert high - low < 11.0
        ui.drag("ruler", ui.at("ruler", (0.7, 0.5)), button=2)
        assert timeline.view[0] < low and ui.session.time.frame == 7
        steps = len(ui.session.history.steps)
        ui.click("field timeline last")
        ui.type("9")
        assert ui.session.time.frames == (1, 9) and len(ui.session.history.steps) == steps + 1
        ui.keys("Ctrl+Z")
        assert ui.session.time.frames == (1, 12)

    gui(body)


def test_keys_by_diamond_and_by_dragging(gui, tmp_path) -> None:
    path, stops = shot(tmp_path), Port("exposure", "stops")

    def body(ui) -> None:
        session = ui.session
        start(ui, graph_of(path, "exposure", frames=(1, 12)))
        session.select([ElementId("exposure")])
        ui.wait(3)
        first = seen(ui)
        ui.click("diamond exposure.stops")
        assert session.time.find_key(stops).value == 0.0
        ui.keys("Shift+RightArrow")
        ui.settled()
        steps = len(session.history.steps)
        x, y = ui.at("field exposure.stops")
        ui.drag((x, y), (x + 40.0, y))
        assert len(session.history.steps) == steps + 1
        assert session.graph.animation.get(stops).frames == (1.0, 12.0) and session.time.find_key(stops).value > 0.2
        ui.settled()
        bright = seen(ui)
        ui.keys("DownArrow")
        assert session.time.frame == 1
        ui.settled()
        np.testing.assert_array_equal(seen(ui), first)
        session.time.seek(6)
        ui.settled()
        assert 0.0 < session.time.evaluate(stops) < session.graph.animation.get(stops).keys[1].value
        ui.move("diamond exposure.stops")
        ui.shot("keys.png")
        ui.keys("UpArrow")
        assert session.time.frame == 12
        ui.settled()
        np.testing.assert_array_equal(seen(ui), bright)
        ui.keys("Ctrl+Z")
        assert session.graph.animation.get(stops).frames == (1.0,), "a drag is one step"

        session.time.seek(5)
        ui.wait(3)
        x, y = ui.at("field exposure.stops")
        ui.drag((x, y), (x + 40.0, y), release=False)
        assert session.graph.animation.get(stops).frames == (1.0, 5.0)
        ui.keys("Escape")
        ui.ctx.mouse_up(0)
        ui.wait(3)
        assert session.graph.animation.get(stops).frames == (1.0,), "and none if it is cancelled"

        ui.click("diamond exposure.stops")
        assert session.graph.animation.get(stops).frames == (1.0, 5.0)
        ui.click("diamond exposure.stops", button=1)
        ui.shot("menu.png")
        ui.click("menu Copy Animation")
        ui.click("diamond exposure.stops", button=1)
        ui.click("menu Remove All Keys")
        assert session.graph.animation.get(stops) is None
        ui.click("diamond exposure.stops", button=1)
        ui.click("menu Paste Animation")
        assert session.graph.animation.get(stops).frames == (1.0, 5.0)
        ui.double_click("name exposure.stops")
        assert session.graph.animation.get(stops) is None

    gui(body)


def test_an_expression_is_typed_after_an_equals_sign(gui, tmp_path) -> None:
    path, stops = shot(tmp_path), Port("exposure", "stops")

    def body(ui) -> None:
        session = ui.session
        start(ui, graph_of(path, "exposure", frames=(1, 12)))
        session.select([ElementId("exposure")])
        ui.wait(3)
        ui.click("field exposure.stops")
        ui.type("=sin(frame / 12 * tau) * 2")
        assert isinstance(session.graph.animation.get(stops), Expression)
        session.time.seek(4)
        ui.settled()
        assert abs(session.time.evaluate(stops) - 1.732) < 0.001
        ui.move("ruler")
        ui.shot("expression.png")
        ui.click("field exposure.stops")
        ui.type("frame / (2 +")
        assert session.graph.animation.get(stops).text == "sin(frame / 12 * tau) * 2", "what was there goes on"
        ui.shot("expression_fault.png")
        ui.editor.store.change(theme="light")
        ui.wait(4)
        ui.shot("expression_light.png")
        ui.editor.store.change(theme="dark")
        ui.click("field exposure.stops")
        ui.type("frame / 8")
        assert session.graph.animation.get(stops).text == "frame / 8"
        ui.click("diamond exposure.stops", button=1)
        ui.click("menu Bake to Keys")
        assert [key.value for key in session.graph.animation.get(stops).keys] == [frame / 8 for frame in range(1, 13)]
        ui.shot("baked.png")

    gui(body)


def test_the_graphs_range_rate_and_preroll(gui, tmp_path) -> None:
    path = shot(tmp_path, range(1001, 1009))

    def body(ui) -> None:
        session = ui.session
        start(ui, graph_of(path, "exposure"))
        assert session.time.frames == (1001, 1008) and session.time.frame == 1001
        ui.click("field frames", fraction=(0.25, 0.5))
        ui.type("1003")
        assert session.root.settings.frames == (1003, 1008)
        ui.click("field preroll")
        assert session.root.settings.preroll == 12
        ui.click("field rate")
        ui.type("25")
        assert session.root.settings.rate == 25.0
        ui.shot("graph.png")
        ui.click("button automatic frames")
        ui.click("button automatic preroll")
        assert (session.root.settings.frames, session.root.settings.preroll) == (None, None)

    gui(body)


def test_missing_frames_are_marked(gui, tmp_path) -> None:
    path = shot(tmp_path)
    for frame in (5, 6):
        (tmp_path / f"bar.{frame:04d}.exr").unlink()

    def body(ui) -> None:
        start(ui, graph_of(path, "exposure"))
        ui.until(lambda: ui.window._panels["Timeline"]._ruler.missing.gaps == ((5, 6),))
        session = ui.session
        session.time.seek(5)
        ui.settled()
        assert "no such file" in ui.editor.preview.fault("A")
        ui.shot("missing.png")
        session.apply(SetValue(Port("read", "missing"), "nearest"))
        ui.settled()
        assert ui.editor.preview.fault("A") is None
        ui.keys("Space")
        ui.until(lambda: len(ui.editor.preview.frames) > 8)
        ui.keys("Space")

    gui(body)


def test_a_far_frame_of_a_graph_with_a_memory_is_what_a_reel_renders(gui, tmp_path) -> None:
    path = shot(tmp_path)
    graph = graph_of(path, "light_trails", frames=(1, 12))

    def body(ui) -> None:
        start(ui, graph)
        wanted = RenderRequest(targets={"A": OUT})

        def rendered(frame: int) -> np.ndarray:
            reel = FrameRenderer(ui.editor.preview.renderer, graph, wanted)
            try:
                return reel.render_frame(frame)["A"].copy()
            finally:
                reel.close()

        ui.session.time.seek(10)
        ui.wait(1)
        ui.settled()
        assert ui.editor.preview.remembers and ui.editor.preview.find_whole_image("A").frame == 10
        far = seen(ui)
        ui.shot("trails.png")
        for frame in (3, 12, 9, 10):
            ui.session.time.seek(frame)
            ui.settled()
        np.testing.assert_array_equal(seen(ui), far, "whatever was shown before")
        np.testing.assert_array_equal(far, ui.ask(lambda: rendered(10)))
        ui.keys("Space")
        ui.until(lambda: len(ui.editor.preview.frames) == 12, 60.0)
        assert ui.editor.timeline.playback.dropped == 0, "a history leaves no frame out"
        ui.keys("Space")

    gui(body)


def test_a_dropped_frame_stands_for_its_sequence_if_wanted(gui, tmp_path) -> None:
    path = shot(tmp_path)

    def body(ui) -> None:
        start(ui, Graph(outputs={"image": Output()}))
        ui.ask(lambda: take_files(ui.editor, ui.window._contexts.documents, [tmp_path / "bar.0003.exr"]))
        ui.wait(3)
        assert "one of 12 frames" in ui.editor.dialogs.question.sentence
        ui.shot("dropped.png")
        dict(ui.editor.dialogs.question.answers)["Read the sequence"]()
        ui.editor.dialogs.question = None
        ui.wait(3)
        node = ui.session.active
        assert ui.session.graph.value(Port(node, "path")) == path and ui.session.time.frames == (1, 12)
        ui.settled()
        ui.until(lambda: not ui.editor.renders.is_busy)
        ui.wait(5)
        ui.shot("sequence.png")
        ui.session.undo()
        ui.ask(
            lambda: take_files(
                ui.editor, ui.window._contexts.documents, [tmp_path / "bar.0003.exr", tmp_path / "bar.0004.exr"]
            )
        )
        assert ui.editor.dialogs.question is None, "several of one sequence are that"
        assert ui.session.graph.value(Port(ui.session.active, "path")) == path

    gui(body)


def test_a_loop_of_cached_frames_is_drawn_through_the_view_once(gui, tmp_path) -> None:
    pattern = shot(tmp_path)

    def body(ui) -> None:
        start(ui, graph_of(pattern, "exposure", size=(64, 36), frames=(1, 12)))
        ui.editor.actions.run("time.play")
        ui.until(lambda: len(ui.editor.preview.frames) == 12)
        frames = set[int]()
        display = ui.editor.display

        def play_all() -> int:
            """How often the display draws until the viewer has shown every frame."""
            before = display.draw_count
            frames.clear()
            ui.until(lambda: frames.add(ui.editor.preview.find_whole_image("A").frame) or len(frames) == 12)
            return display.draw_count - before

        play_all()
        assert play_all() == 0
        ui.editor.viewer.exposure = 1.0  # all of them look different now
        assert play_all() >= 11
        ui.editor.actions.run("time.play")
        ui.settled()
        assert not any(slot.startswith("viewer ") for slot in display._slots), "slots are given back"

    gui(body)

"""What the editor costs. Run it as `.venv/bin/python tests/bench/editor.py`; it prints JSON.

- `frame`: seconds of Python per frame with 100 nodes on the canvas (at most 0.004 is wanted)
- `drag`: pictures per second while an exposure at the end of ten nodes at 1920x1080 is dragged (10 or more), and
  seconds of all processors for each: a busy machine shows fewer pictures, but they cost the same
- `zoomed`: milliseconds, and those of all processors, from a changed value to its picture at 1920x1080 and 3840x2160
  without a proxy, where 640x360 pixels are seen: these alone, the whole picture, and the ratios. Drawing the window is
  not in it
- `idle`: share of one core while nothing happens (below 0.1)
- `start`: seconds from the start of the process to the first picture, with warm caches (below 1.5)
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from halation.authoring.edits.element_id import ElementId
from halation.resources.sandbox import UNRESTRICTED

sys.path.append(str(Path(__file__).parents[1]))

import numpy as np
from gui_driver import Ui, drive, headless
from halation import document
from halation.authoring.commands import ArrangeElements
from halation.authoring.preview import Preview, VisibleRegion
from halation.editor.window.panels import DOCKED
from halation.graph import Graph, Port
from halation.renderer import Display, Renderer
from imgui_bundle import ImVec2, immapp
from node_chains import make_chain

_TEN = (
    "exposure",
    "saturation",
    "grade",
    "gaussian_blur",
    "vignette",
    "exposure",
    "clip",
    "saturation",
    "bloom",
    "exposure",
)
_STACK = ("exposure", "gaussian_blur", "vignette", "tone_map", "grade", "saturation")
_CAST = (
    "exposure",
    "grade",
    "saturation",
    "vignette",
    "clip",
    "gaussian_blur",
    "tone_map",
    "bloom",
    "edge_detect",
    "mix_images",
)


def measure_frame(folder: Path) -> dict[str, float]:
    """Python per frame, by panel, with 100 nodes in view."""
    graph = make_chain([_CAST[number % len(_CAST)] for number in range(99)], (320, 180))
    path = folder / "hundred.json"
    document.save(graph, path, sandbox=UNRESTRICTED)
    times_by_panel: dict[str, list[float]] = {}

    def body(ui: Ui) -> None:
        ui.session.apply(ArrangeElements(ui.editor.canvas.sizes or {}, ui.editor.canvas.find_pins()))
        ui.editor.canvas.fit()
        ui.settled()
        panels = ui.window._panels
        for title in (docked.title for docked in DOCKED):
            _time_panel(panels, title, times_by_panel)
        ui.wait(120)

    drive(body, folder, path, size=(1920, 1200))
    medians = {title: statistics.median(times[20:]) for title, times in times_by_panel.items() if len(times) > 40}
    return {**medians, "total": sum(medians.values())}


def _time_panel(panels: dict[str, Any], title: str, times_by_panel: dict[str, list[float]]) -> None:
    inner, times = panels[title].draw, times_by_panel.setdefault(title, [])

    def draw() -> None:
        started = time.perf_counter()
        inner()
        times.append(time.perf_counter() - started)

    panels[title].draw = draw


def measure_drag(folder: Path) -> dict[str, float]:
    """Pictures per second while the mouse drags the last exposure in the inspector, without a coarser one meanwhile."""
    path = folder / "ten.json"
    document.save(make_chain(list(_TEN), (1920, 1080)), path, sandbox=UNRESTRICTED)
    figures: dict[str, float] = {}

    def body(ui: Ui) -> None:
        ui.session.select([ElementId("n9")])
        ui.settled()
        seen, values, steps = set[int](), set[object](), 0
        left, y = ui.at("field n9.stops", (0.3, 0.5))
        ui.drag((left, y), (left + 8, y), release=False)
        started, before = time.perf_counter(), sum(os.times()[:2])
        while time.perf_counter() - started < 5.0:
            steps += 1
            ui.ctx.inputs.mouse_pos_value = ImVec2(left + 8 + steps % 60, y)  # moved once a frame, as by a hand
            ui.wait(1)
            values.add(ui.session.graph.value(Port("n9", "stops")))
            shown = ui.editor.preview.find_whole_image("A")
            assert shown is not None and shown.scale == 1.0
            seen.add(shown.revision)
        spent, used = time.perf_counter() - started, sum(os.times()[:2]) - before
        ui.ctx.mouse_up(0)
        assert len(values) > 10, "the mouse drags it"
        figures.update(pictures=len(seen) / spent, frames=steps / spent, processor=used / len(seen))

    drive(body, folder, path, size=(1920, 1200), likes={"proxy_while_dragging": False})
    return figures


def measure_zoomed(folder: Path) -> dict[str, Any]:
    """The first of six nodes, a blur and the last one, each changed while a ninth or a thirty-sixth is seen."""
    table: dict[str, Any] = {}
    renderer = Renderer(sandbox=UNRESTRICTED)
    for width, height in ((1920, 1080), (3840, 2160)):
        box = (0.3, 0.3, 0.3 + 640 / width, 0.3 + 360 / height)
        glimpse, graph = VisibleRegion(box, (width, height), frozenset("A")), make_chain(list(_STACK), (width, height))
        preview, value = Preview(renderer, Display(renderer.device)), 1.0
        preview.thumbnailing = False
        for word in ("n0.stops", "n1.sigma", "n5.saturation"):
            steps = {part: list[tuple[float, float]]() for part in (True, False)}
            for turn, part in enumerate((True, False) * 7):
                preview.glimpse = None
                while preview.work(60.0):
                    time.sleep(0.001)
                preview.glimpse = glimpse if part else None
                for step in range(4):
                    value += 0.003
                    graph = graph.set(Port.parse(word), value)
                    taken = _time_until_seen(preview, graph)
                    seen = preview.find_visible_image("A")
                    assert seen is not None and seen.partial == part
                    if turn > 1 and step:  # before, programs are compiled and caches filled
                        steps[part].append(taken)
            parts, wholes = (np.median(steps[part], axis=0) for part in (True, False))
            figures = {"part": parts, "whole": wholes, "ratio": parts / wholes}
            table[f"{width}x{height} {word}"] = {
                name: median_times.round(3).tolist() for name, median_times in figures.items()
            }
        preview.close()
    renderer.close()
    return table


def _time_until_seen(preview: Preview, graph: Graph) -> tuple[float, float]:
    """Milliseconds until what can be seen of a graph is there, and those of all processors."""
    began, used = time.perf_counter(), time.process_time()
    preview.want(graph, {"A": Port("outputs", "image")})
    while preview.busy and not preview.completing:
        preview.work(0.0)
    return (time.perf_counter() - began) * 1e3, (time.process_time() - used) * 1e3


def measure_idle(folder: Path) -> float:
    """Processor time per second of doing nothing, without the test engine, which never rests."""
    window = headless(folder, folder / "ten.json", size=(1600, 1000))
    before, marks = window.params.callbacks.before_imgui_render, list[tuple[float, float]]()
    begun = time.perf_counter()

    def after_frame() -> None:
        before()
        resting = window.params.fps_idling
        if resting.is_idling:  # a display would wait so long for events; the platform without one returns at once
            time.sleep(1.0 / resting.fps_idle)
        now = time.perf_counter()
        if now - begun > 8.0 and not window.editor.preview.busy:  # it rests some seconds after the last event
            used = os.times()
            marks.append((now, used.user + used.system))
        if marks and now - marks[0][0] > 6.0:
            window.editor.commands.closing = True

    window.params.callbacks.before_imgui_render = after_frame
    immapp.run(window.params, immapp.AddOnsParams())
    return (marks[-1][1] - marks[0][1]) / (marks[-1][0] - marks[0][0])


def measure_start(folder: Path) -> float:
    """Seconds until the window shows its first picture, best of three."""
    code = (
        "import sys,time,os;sys.path.append(sys.argv[1])\n"
        "from gui_driver import drive\nfrom pathlib import Path\n"
        "def body(ui):\n ui.until(lambda: ui.editor.preview.find_whole_image('A') is not None)\n print('shown')\n"
        "drive(body, Path(sys.argv[2]), Path(sys.argv[3]))"
    )
    preset = next(iter(sorted((Path(__file__).parents[2] / "presets").glob("agx_look.json"))))
    times: list[float] = []
    for _ in range(3):
        started = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-c", code, str(Path(__file__).parents[1]), str(folder), str(preset)],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert process.stdout
        assert any("shown" in line for line in process.stdout)
        times.append(time.perf_counter() - started)
        process.wait()
    return min(times)


def main() -> None:
    """Measure what the words name, or everything."""
    figures = {
        "frame": measure_frame,
        "drag": measure_drag,
        "zoomed": measure_zoomed,
        "idle": measure_idle,
        "start": measure_start,
    }
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.environ["HALATION_STATE"] = str(folder / "state")
        print(json.dumps({word: figures[word](folder) for word in sys.argv[1:] or figures}, indent=2))


if __name__ == "__main__":
    main()

"""The parts of a measurement of a card: copies, work, presets. Each adds to the results what it found."""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
from bench.gpu_copies import queries_against_clock, time_copies
from bench.gpu_pictures import PRESETS, file_of, render
from bench.gpu_table import FORMS, PRECISIONS
from bench.gpu_work import DRY, UHD2, WORK, Work, least_bytes, make_picture, select_measured
from bench.results import Results
from bench.started import run_process
from halation import document
from halation.compiler import Form
from halation.errors import HalationError
from halation.graph import Graph
from halation.media.comparison.metrics import measure_flip
from halation.renderer import Device, FrameRenderer, Renderer, RenderRequest
from halation.renderer.bench import load_frame_inputs, measure_graph
from halation.renderer.opengl.device import OpenGLDevice
from halation.resources.sandbox import UNRESTRICTED
from msgspec import structs

Say = Callable[[str], None]
DRY_PRESETS = 3
SCRIPT = Path(__file__).with_name("gpu_pictures.py")


def measure_copies(results: Results, device: Device, given: argparse.Namespace, say: Say) -> None:
    """The bandwidth of the card."""
    size, by_query = DRY if given.dry else UHD2, not device.target.software
    say("copies")
    assert isinstance(device, OpenGLDevice)
    with device.save_draw_target() as context:
        results.extras["queries"] = queries_against_clock(context, size)
        found = time_copies(context, size, given.repeat, by_query)
    results.extras["copies"] = {
        one.way: {**asdict(one), "seconds": list(one.seconds), "bandwidth": one.bandwidth} for one in found
    }


def measure_work(results: Results, device: Device, given: argparse.Namespace, say: Say) -> None:
    """Every graph in every form and precision, all in turn."""
    forms: list[Form] = [form for form in FORMS if form == "fragment" or device.target.version >= 430]
    engines = {form: engine(device, form) for form in forms}
    for name in given.work:
        work = replace(WORK[name], size=DRY) if given.dry else WORK[name]
        graph = document.load(work.path, sandbox=UNRESTRICTED)
        inputs = {name: make_picture(work.size) for name in work.inputs}
        for turn in range(given.rounds):
            for precision in PRECISIONS:
                for form, renderer in engines.items():
                    say(f"{name} {form} {precision}, {turn + 1} of {given.rounds}")
                    wanted = RenderRequest(inputs, size=None if inputs else work.size, precision=precision)
                    take(results, work, f"{form} {precision}", renderer, graph, wanted, given.repeat)
    for renderer in engines.values():
        renderer.close()


def engine(device: Device, form: Form) -> Renderer:
    """A renderer with another form of passes on the same context."""
    target = structs.replace(device.target, form=form, why="measured here")
    return Renderer(device.with_target(target), budget=0, sandbox=UNRESTRICTED)


def take(
    results: Results, work: Work, program: str, renderer: Renderer, graph: Graph, wanted: RenderRequest, repeat: int
) -> None:
    """One turn of a graph: pass by pass, then as whole frames that nobody waits for."""
    one = results.run("x".join(map(str, work.size)), work.name, program)
    if one.error:
        return
    try:
        passes = select_measured(measure_graph(renderer, graph, wanted, (wanted.frame,), repeat, 2).passes)
        one.op += [sum(each) for each in zip(*(timed.seconds for timed in passes), strict=True)]
        one.wall += frames(renderer, graph, wanted, repeat)
    except HalationError as fault:
        one.error = str(fault)
        return
    known: dict[str, Any] = {
        "moved": sum(timed.bytes_read + timed.bytes_written for timed in passes),
        "passes": len(passes),
        "floor": least_bytes(renderer.compile(graph, wanted)),
        "each": [
            {
                "functions": list(timed.functions),
                "median": timed.median,
                "moved": timed.bytes_read + timed.bytes_written,
            }
            for timed in passes
        ],
    }
    results.extras.setdefault("bytes", {}).setdefault(work.name, {})[program] = known


def frames(renderer: Renderer, graph: Graph, wanted: RenderRequest, repeat: int) -> list[float]:
    """Seconds of whole frames by the clock, from the first pass that is submitted to the last that is done."""
    reel = FrameRenderer(renderer, graph, wanted)
    plan, given, seconds = reel.plan_frame(wanted.frame), load_frame_inputs(renderer, reel, wanted.frame), list[float]()
    for _ in range(repeat + 1):
        kept = renderer.runner.create_lease()
        finish(renderer.device)
        started = time.perf_counter()
        with renderer.runner.start_run(plan, kept) as steps:
            for _ in steps:
                pass
        finish(renderer.device)
        seconds.append(time.perf_counter() - started)
        kept.close()
    given.close()
    reel.close()
    return seconds[1:]


def finish(device: Device) -> None:
    """Wait for all that was submitted."""
    with device.make_current():
        device.finish()


def measure_presets(results: Results, device: Device, given: argparse.Namespace, say: Say) -> None:
    """How far presets are from what the software rasterizer makes of them: means of FLIP."""
    names, scale = given.presets or list(PRESETS[:DRY_PRESETS] if given.dry else PRESETS), 0.2 if given.dry else 1.0
    renderer, found = Renderer(device, sandbox=UNRESTRICTED), dict[str, dict[str, Any]]()
    with tempfile.TemporaryDirectory(prefix="halation-bench-") as made:
        folder = given.software or Path(made)
        for precision in PRECISIONS:
            say(f"presets by the software rasterizer, {precision}")
            words = [str(folder), "--precision", precision, "--presets", ",".join(names), "--scale", str(scale)]
            ended = run_process([sys.executable, str(SCRIPT), *words], patience=3600.0)
            if ended.code:
                raise SystemExit(ended.output[-2000:])
        for precision in PRECISIONS:
            say(f"presets by {device.target.renderer}, {precision}")
            for name, array in render(renderer, names, precision, scale):
                there = np.load(file_of(folder, precision, name, scale))["image"]
                found.setdefault(name, {})[precision] = measure_flip(array, there)
        for name, one in found.items():
            half, full = (np.load(file_of(folder, kind, name, scale))["image"] for kind in PRECISIONS)
            one["rounding"] = measure_flip(half, full)
    renderer.close()
    results.extras["presets"] = found

"""`halation demo`: renders every preset on the sample frame."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import UNRESTRICTED, read_process_sandbox
from .batch import find_middle_frame, open_batch
from .options import AsJson
from .outcome import print_json


def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder to write to.")] = Path("out"),
    as_json: AsJson = False,
) -> int:
    """Render every preset on the sample frame.

    Writes each as PNG and EXR; of an animated preset it renders the frame in the middle.
    """
    from halation.presets import paths

    from .. import document
    from ..renderer import RenderRequest
    from ..renderer.jobs.job import OutputSettings, run_job

    sandbox = read_process_sandbox()
    rows: list[dict[str, object]] = []
    with open_batch(output, len(paths()), sandbox=sandbox) as batch:
        for path in paths():
            batch.step(path.stem)
            started = time.perf_counter()
            graph = document.load(path, sandbox=UNRESTRICTED)
            first = next(iter(graph.outputs))
            pictures = (("", output / f"{path.stem}.exr"), (first, output / f"{path.stem}.png"))
            report = run_job(
                batch.renderer,
                graph,
                RenderRequest(),
                OutputSettings(pictures),
                (find_middle_frame(batch.renderer, graph),),
            )
            seconds = time.perf_counter() - started
            word = "pass  " if report.passes == 1 else "passes"
            batch.say(f"{path.stem:<24} {report.passes:>3} {word}  {seconds:5.2f} s  {pictures[1][1]}")
            written = [str(item) for item in report.written]
            rows.append({"preset": path.stem, "seconds": round(seconds, 3), "written": written})
    if as_json:
        print_json({"device": batch.device, "pictures": rows})
    return 0

"""`halation demo`: every preset over the sample frame."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson
from .outcome import note, print_json


def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder to write to.")] = Path("out"),
    as_json: AsJson = False,
) -> int:
    """Render every preset on the sample frame, as PNG and EXR."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    from ...presets import paths
    from .. import document
    from ..errors import OutputError
    from ..renderer import Renderer, Wanted, open_device
    from ..renderer.job import Writing, run_job

    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(f"{output}: the folder cannot be made ({fault.strerror}); choose another with -o") from None
    renderer = Renderer(open_device(), budget=0)
    note(renderer.device.description)
    console = Console(stderr=True)
    done: list[dict[str, object]] = []
    columns = (TextColumn("{task.description:<24}", markup=False), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        files = paths()
        task = progress.add_task("", total=len(files))
        for path in files:
            progress.update(task, description=path.stem)
            started = time.perf_counter()
            graph = document.load(path)
            first = next(iter(graph.outputs))
            pictures = (("", output / f"{path.stem}.exr"), (first, output / f"{path.stem}.png"))
            report = run_job(renderer, graph, Wanted(), Writing(pictures))
            spent = time.perf_counter() - started
            word = "pass  " if report.passes == 1 else "passes"
            line = f"{path.stem:<24} {report.passes:>3} {word}  {spent:5.2f} s  {pictures[1][1]}"
            progress.console.print(line, soft_wrap=True, markup=False, highlight=False)
            progress.advance(task)
            written = [str(item) for item in report.written]
            done.append({"preset": path.stem, "seconds": round(spent, 3), "written": written})
    if as_json:
        print_json({"device": renderer.device.description, "pictures": done})
    return 0

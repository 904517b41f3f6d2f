"""`halation demo`: every preset over the sample frame."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from .options import AsJson
from .outcome import guarded, note, print_json


@guarded
def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder to write to.")] = Path("out"),
    as_json: AsJson = False,
) -> None:
    """Render every preset on the sample frame, as PNG and EXR."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    from ...presets import paths
    from .. import document
    from ..errors import OutputError
    from ..renderer import Renderer, Wanted
    from ..renderer.job import Writing, run_job

    renderer = Renderer(budget=0)
    note(renderer.device.description)
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise OutputError(f"{output}: the folder cannot be made ({fault.strerror}); choose another with -o") from None
    done: list[dict[str, object]] = []
    columns = (TextColumn("{task.description:<24}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=Console(stderr=True)) as progress:
        files = paths()
        task = progress.add_task("", total=len(files))
        for path in files:
            progress.update(task, description=path.stem)
            started = time.perf_counter()
            graph = document.load(path)
            first = next(iter(graph.outputs))
            pictures = {"": output / f"{path.stem}.exr", first: output / f"{path.stem}.png"}
            report = run_job(renderer, graph, Wanted(), Writing(pictures))
            spent = time.perf_counter() - started
            progress.console.print(f"{path.stem:<24} {report.passes:>3} passes  {spent:5.2f} s  {pictures[first]}")
            progress.advance(task)
            written = [str(item) for item in report.written]
            done.append({"preset": path.stem, "seconds": round(spent, 3), "written": written})
    if as_json:
        print_json({"device": renderer.device.description, "pictures": done})

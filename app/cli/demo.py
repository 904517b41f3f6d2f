"""`halation demo`: renders every preset on the sample frame."""

from __future__ import annotations

import shutil
import time
from pathlib import Path
from typing import Annotated

import typer

from ..resources.sandbox import UNRESTRICTED, read_process_sandbox
from .batch import find_middle_frame, open_batch
from .options import AsJson
from .outcome import print_json, print_note


def demo(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder to write to.")] = Path("out"),
    listed: Annotated[bool, typer.Option("--list", help="Print the names of all presets, and render nothing.")] = False,
    copy: Annotated[
        Path | None,
        typer.Option(
            "--copy", metavar="FOLDER", help="Copy the presets and the sample frame to a folder, and render nothing."
        ),
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Render every preset on the sample frame.

    Writes each as PNG and EXR; of an animated preset it renders the frame in the middle.
    """
    if listed:
        return _list_presets(as_json)
    if copy is not None:
        return _copy_presets(copy, as_json)
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


def _list_presets(as_json: bool) -> int:
    from ..custom_nodes.plugins import name_presets
    from .plugins import describe_refused_plugins, print_refused_plugins

    if as_json:
        print_json(
            {"presets": {name: str(path) for name, path in name_presets().items()}, **describe_refused_plugins()}
        )
    else:
        print(*name_presets(), sep="\n")
        print_refused_plugins()
    return 0


def _copy_presets(folder: Path, as_json: bool) -> int:
    """Copy the presets and their samples. Files that are there already stay. Raises OutputError."""
    from halation.presets import paths, sample

    from ..errors import OutputError

    samples = [path for path in sorted(sample().parent.iterdir()) if path.is_file()]
    copies = {path: folder / path.name for path in paths()} | {path: folder / "samples" / path.name for path in samples}
    for target in copies.values():
        if target.exists():
            raise OutputError(f"{target}: the file is there already; name a new folder after --copy")
    try:
        (folder / "samples").mkdir(parents=True, exist_ok=True)
        for path, target in copies.items():
            shutil.copyfile(path, target)
    except OSError as fault:
        raise OutputError(f"{fault.filename2 or fault.filename}: it cannot be written ({fault.strerror})") from None
    if as_json:
        print_json({"copied": [str(target) for target in copies.values()]})
    else:
        print_note(f"{folder}: {len(paths())} presets; the sample frame is {folder / 'samples' / sample().name}")
    return 0

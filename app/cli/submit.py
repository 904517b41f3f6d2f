"""`halation submit`: writes the files with which render farms render frames of a graph."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import UsageError
from ..resources.sandbox import Sandbox
from . import parsing
from .options import (
    AsJson,
    Frames,
    GraphFile,
    Inputs,
    Memory,
    Node,
    Outputs,
    Precision,
    Scale,
    Sets,
    SizeText,
    View,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json, print_note, write_count

if TYPE_CHECKING:
    from .farm_files import FarmFile, FarmJob

_FILE = "FILE"


_Output = Annotated[
    list[str],
    Outputs,
]
_Openjd = Annotated[
    Path | None, typer.Option("--openjd", metavar=_FILE, help="Write a template of Open Job Description 2023-09.")
]
_Slurm = Annotated[
    Path | None, typer.Option("--slurm", metavar=_FILE, help="Write a script for arrays of Slurm (sbatch).")
]
_Actions = Annotated[Path | None, typer.Option("--actions", metavar=_FILE, help="Write a workflow of GitHub Actions.")]
_Chunk = Annotated[int, typer.Option("--chunk", min=1, metavar="N", help="Frames of one task.")]
_Gpu = Annotated[bool, typer.Option("--gpu", help="Ask for machines with a GPU.")]


def submit(
    graph: GraphFile,
    output: _Output,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frames: Frames = None,
    precision: Precision = None,
    memory: Memory = None,
    view: View = "",
    openjd: _Openjd = None,
    slurm: _Slurm = None,
    actions: _Actions = None,
    chunk: _Chunk = 10,
    gpu: _Gpu = False,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Write job files for render farms.

    The machines of a farm share the frames of a graph.
    """
    from .farm_files import FarmJob

    if str(graph) == "-":
        raise UsageError("-: a farm cannot read standard input: name a graph file")
    if not (openjd or slurm or actions):
        raise UsageError("no file is named: write --openjd job.yaml, --slurm job.sh or --actions workflow.yml")
    chosen_frames, is_shared = _choose_frames(graph, inputs, sets, node, frames, output, sandbox)
    words = tuple(_list_words(graph, output, inputs, sets, node, size, scale, precision, memory, view))
    job = FarmJob(graph.stem, words, (), gpu, parsing.parse_memory(memory))
    frames_per_task = chunk if is_shared else len(chosen_frames)
    task_counts = _write_files(job, chosen_frames, frames_per_task, (openjd, slurm, actions), sandbox)
    if as_json:
        print_json({"written": list(task_counts), "frames": len(chosen_frames), "tasks": task_counts})
    for path, count in task_counts.items() if not as_json else ():
        print_note(f"{path}  {len(chosen_frames)} frames in {write_count(count, 'task')}")
    return 0


def _write_files(
    job: FarmJob, frames: Sequence[int], frames_per_task: int, paths: tuple[Path | None, ...], sandbox: Sandbox
) -> dict[str, int]:
    """Write those files of a job that have a path: for Open Job Description, Slurm and GitHub Actions.

    Returns how many tasks each has, by its path.
    """
    from msgspec.structs import replace

    from ..resources.atomic_write import write_text_atomically
    from .farm_files import MAX_MATRIX_TASKS, MAX_TASKS, divide_frames, write_actions, write_openjd, write_slurm

    openjd, slurm, actions = paths
    writers: tuple[tuple[Path | None, Callable[[FarmJob], str], int], ...] = (
        (openjd, lambda chunked: write_openjd(chunked, openjd.parent if openjd else Path()), MAX_TASKS),
        (slurm, write_slurm, MAX_TASKS),
        (actions, write_actions, MAX_MATRIX_TASKS),
    )
    task_counts: dict[str, int] = {}
    for path, write, most in writers:
        if path is not None:
            chunks = divide_frames(frames, frames_per_task, most)
            write_text_atomically(path, write(replace(job, chunks=chunks)), sandbox)
            task_counts[str(path)] = len(chunks)
    return task_counts


def _choose_frames(
    path: Path,
    inputs: Sequence[str] | None,
    sets: Sequence[str] | None,
    node: str,
    frames: str | None,
    output: Sequence[str],
    sandbox: Sandbox,
) -> tuple[tuple[int, ...], bool]:
    """The frames of the job, by default all of the graph, and whether tasks can share them. Raises HalationError."""
    from msgspec.structs import replace

    from ..graph.frames import check_numbered, is_video
    from ..renderer.jobs.render_job import RenderJob
    from .job_setup import choose_frames, has_independent_frames

    graph = open_graph(path, parsing.parse_sets(sets), sandbox=sandbox)
    report_problems(path, graph)
    files = parsing.parse_destinations(output)
    bindings = resolve_inputs(graph, parsing.parse_inputs(inputs))
    job = RenderJob(sandbox=sandbox, inputs=bindings, destinations=tuple((name, str(file)) for name, file in files))
    chosen = parsing.parse_frame_options(None, frames) or choose_frames(job, graph, bindings)
    for _, file in files:
        check_numbered(str(file), chosen)
    targets = parsing.find_targets(graph, node)
    is_video_written = any(is_video(str(file)) for _, file in files)
    return chosen, not is_video_written and has_independent_frames(replace(job, frames=chosen), graph, targets)


def _list_words(
    graph: Path,
    output: Sequence[str],
    inputs: Sequence[str] | None,
    sets: Sequence[str] | None,
    node: str,
    size: str | None,
    scale: float,
    precision: str | None,
    memory: str | None,
    view: str,
) -> Iterator[str | FarmFile]:
    """The words of `halation render` for these options, without frames. Raises UsageError."""
    from ..custom_nodes.plugins import find_preset
    from ..media.layers import split_layer
    from .farm_files import FarmFile

    yield "render"
    is_preset = find_preset(graph.stem) == graph
    path = f"./{graph}" if str(graph).startswith("-") else str(graph)  # else it would be an option
    yield graph.stem if is_preset else FarmFile("", path, about="the graph")
    for name, text in parsing.parse_inputs(inputs).items():
        file, layer = split_layer(text)
        before, after = f"--input={name}=" if name else "--input=", f":{layer}" if layer else ""
        path = PurePath(file)
        if "#" in path.name or "%" in path.name:  # farms send folders of sequences, and no names with places
            yield FarmFile(
                before, str(path.parent), f"/{path.name}{after}", f"the folder of input {name}".strip(), True
            )
        else:
            yield FarmFile(before, file, after, f"input {name}".strip())
    for name, path in parsing.parse_destinations(output):
        before = f"--output={name}=" if name else "--output="
        yield FarmFile(
            before, str(path.parent), f"/{path.name}", "the folder of the frames", is_folder=True, is_output=True
        )
    yield from (f"--set={name}={text}" for name, text in parsing.parse_sets(sets).items())
    options: Mapping[str, str | None] = {
        "--node": node,
        "--size": size,
        "--scale": "" if scale == 1.0 else repr(parsing.parse_scale(scale)),
        "--precision": precision,
        "--memory": memory,
        "--view": view,
    }
    yield from (f"{flag}={text}" for flag, text in options.items() if text)
    yield "--resume"

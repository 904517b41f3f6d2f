"""What a render job sends to a cluster: what all of its chunks share, and the files that each of its parts reads."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING
from uuid import uuid4

from msgspec.structs import replace

from ..errors import HalationError, OutputError
from ..graph.frames import Pattern
from ..resources.atomic_write import describe_write_error
from . import parsing
from .execute_batch import open_entry_graph
from .job_setup import choose_frames, find_remembering_node, make_output_settings, make_request
from .options import resolve_inputs
from .outcome import print_note

if TYPE_CHECKING:
    from ..cluster.chunk import ChunkStage, FileMark, FrameChunk
    from ..cluster.file_marks import FileHashing, FileMarker
    from ..graph import Graph
    from ..renderer.jobs.render_entry import RenderEntry
    from ..renderer.jobs.render_job import RenderJob

PathPairs = tuple[tuple[str, str], ...]

MarkFiles = Callable[[tuple[int, ...]], Mapping[str, "FileMark"]]
"""The files that parts of a job read, by absolute path."""


def prepare_chunk(job: RenderJob, graph: Graph, path_map: PathPairs) -> tuple[FrameChunk, MarkFiles]:
    """What all chunks of a job share whose parts are frames, and what describes their files.

    Raises HalationError for what can be known before anything is rendered.
    """
    from ..cluster.file_marks import FileMarker
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer.jobs.destinations import plan_destinations

    inputs = _make_absolute_inputs(graph, job.inputs)
    targets = parsing.find_targets(graph, job.node)
    job = replace(job, inputs=inputs, frames=job.frames or choose_frames(job, graph, inputs))
    request, settings = make_request(job, inputs, targets), make_output_settings(job, job.files)
    plan_destinations(graph, request, settings, job.frames, job.sandbox)
    _check_folders(job, path_map)
    node, has_stages = find_remembering_node(job, graph, targets)
    first = LazyResourceProvider(job.sandbox).find_frames(graph, inputs)[0]
    stage = _open_stage(job, first) if has_stages and not job.videos else None
    if job.videos:
        print_note(f"one worker renders all frames, since all are in {job.videos[0]}")
    elif stage is not None:
        print_note(f"node '{node}' needs the frame before each: one worker at a time renders what it stores")
    elif node:
        print_note(f"one worker renders all frames: node '{node}' needs the frame before each")
    is_chain = bool(job.videos or node) and stage is None
    history = first if is_chain or graph.settings.preroll is not None else None
    marker = FileMarker(graph, inputs, job.sandbox)
    chunk = _fill_chunk(job, graph, path_map, marker)

    def mark_files(frames: tuple[int, ...]) -> Mapping[str, FileMark]:
        return marker.mark_files(frames, _find_history(graph, frames, history))

    return replace(chunk, is_chain=is_chain, stage=stage), mark_files


def prepare_entries(job: RenderJob, graph: Graph, path_map: PathPairs) -> tuple[FrameChunk, MarkFiles]:
    """What all chunks of a job share whose parts are files, and what describes the files that these read."""
    from ..cluster.file_marks import FileHashing, FileMarker

    entries = tuple(map(_make_absolute_entry, job.entries))
    remembers, hashing = _has_history(job, graph), FileHashing(job.sandbox)
    chunk = _fill_chunk(replace(job, entries=entries), graph, path_map, FileMarker(graph, {}, job.sandbox))

    def list_files(entry: RenderEntry) -> list[str]:
        try:
            return _list_entry_files(job, graph, entry, hashing, remembers=remembers)
        except HalationError:  # the worker says so
            return []

    def mark_files(numbers: tuple[int, ...]) -> Mapping[str, FileMark]:
        return hashing.mark_paths([path for number in numbers for path in list_files(entries[number - 1])])

    return replace(chunk, numbers=tuple(range(1, len(entries) + 1))), mark_files


def describe_share(job: RenderJob, graph: Graph) -> FrameChunk:
    """What the parts of a job share that other processes of this machine render: the same files, the same code."""
    from ..cluster.chunk import FrameChunk

    inputs = _make_absolute_inputs(graph, job.inputs)
    folder = os.path.abspath(graph.folder)  # noqa: PTH100 - links stay
    return FrameChunk(_describe_sent(replace(job, inputs=inputs), graph), folder, topic="share")


def _describe_sent(job: RenderJob, graph: Graph) -> RenderJob:
    """A job as it is sent: with its whole graph, and absolute paths."""
    from ..renderer.jobs.header import dump_whole_graph

    return replace(
        job,
        graph="-",
        document=dump_whole_graph(graph),
        sets={},
        destinations=_make_absolute_files(job.destinations),
        processes=1,
    )


def _fill_chunk(job: RenderJob, graph: Graph, path_map: PathPairs, marker: FileMarker) -> FrameChunk:
    """What the parts of a job share, of whichever kind they are."""
    from ..cluster.chunk import FrameChunk
    from ..cluster.versions import describe_versions

    return FrameChunk(
        _describe_sent(job, graph),
        os.path.abspath(graph.folder),  # noqa: PTH100 - links stay
        path_map,
        contents=marker.read_contents(),
        versions=describe_versions(graph),
    )


def _open_stage(job: RenderJob, first: int) -> ChunkStage | None:
    """Where the stages of a job with a history share their results; None where it has none before its frames."""
    from ..cluster.chunk import ChunkStage
    from ..renderer.jobs.shared_results import FOLDER_PREFIX

    if len(set(job.frames)) < 2 or max(job.frames) <= first:
        return None
    folder = Path(os.path.abspath(job.files[0][1])).parent / f"{FOLDER_PREFIX}{uuid4().hex[:12]}"  # noqa: PTH100
    return ChunkStage(folder=str(folder), frame_before=first)


def _check_folders(job: RenderJob, path_map: PathPairs) -> None:
    """Raise OutputError for a folder that is missing here, unless it has another path elsewhere: all machines see the
    same folders, and would say so of every frame.
    """
    for _, path in job.destinations:
        pattern = Pattern.parse(path)
        file = path if pattern is None else pattern.name(job.frames[0])
        folder = Path(_make_absolute(file)).parent
        if not folder.exists() and not any(folder.is_relative_to(before) for before, _ in path_map):
            missing = FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
            raise OutputError(f"{file}: cannot be written: {describe_write_error(missing)}")


def _find_history(graph: Graph, frames: Sequence[int], first: int | None) -> range:
    """The frames before a chunk whose files are read too."""
    if first is None or frames[0] <= first:
        return range(0)
    preroll = graph.settings.preroll
    return range(first if preroll is None else max(first, frames[0] - preroll), frames[0])


# --- files as parts ------------------------------------------------------------------------------------------------


def _has_history(job: RenderJob, graph: Graph) -> bool:
    """True if frames need those before them, judged by the first file: the others have the same nodes."""
    if graph.settings.preroll is not None:
        return True
    entry = job.entries[0]
    try:
        graph = open_entry_graph(graph, entry)
        inputs = _make_absolute_inputs(graph, entry.inputs)
        frames = job.frames or choose_frames(replace(job, destinations=entry.destinations), graph, inputs)
        job = replace(job, inputs=inputs, frames=frames)
        return bool(find_remembering_node(job, graph, parsing.find_targets(graph, job.node))[0])
    except HalationError:  # the worker says so
        return False


def _list_entry_files(
    job: RenderJob, graph: Graph, entry: RenderEntry, hashing: FileHashing, *, remembers: bool
) -> list[str]:
    """The files that are read for one of many files. Raises HalationError."""
    from ..cluster.file_marks import FileMarker
    from ..inputs.lazy_provider import LazyResourceProvider

    graph = open_entry_graph(graph, entry)
    inputs = resolve_inputs(graph, entry.inputs)
    frames = job.frames or choose_frames(replace(job, destinations=entry.destinations), graph, inputs)
    first = LazyResourceProvider(job.sandbox).find_frames(graph, inputs)[0] if remembers else None
    marker = FileMarker(graph, inputs, job.sandbox, hashing)
    return marker.list_files(frames, _find_history(graph, frames, first))


def _make_absolute_entry(entry: RenderEntry) -> RenderEntry:
    inputs = {name: _make_absolute(file) for name, file in entry.inputs.items()}
    return replace(entry, inputs=inputs, destinations=_make_absolute_files(entry.destinations))


def _make_absolute_inputs(graph: Graph, inputs: Mapping[str, str]) -> dict[str, str]:
    return {name: _make_absolute(file) for name, file in resolve_inputs(graph, inputs).items()}


def _make_absolute_files(destinations: Sequence[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    return tuple((name, _make_absolute(file)) for name, file in destinations)


def _make_absolute(file: str) -> str:
    """The absolute path of a file, with its layer if it names one; links stay."""
    return os.path.abspath(file)  # noqa: PTH100

"""Renders chunks of a job for a worker of a cluster: each is a line of JSON, and so is the answer for each frame.

The device, its programs, and the last graph stay from chunk to chunk. All chunks of one process have the same device
settings: the worker starts another process for others.
"""

from __future__ import annotations

import base64
import contextlib
import json
import os
import select
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import to_builtins
from msgspec.structs import replace

from ..cluster.chunk import EntryOutcome, FrameChunk
from ..cluster.path_map import PathMap
from ..cluster.render_process import IDLE_SECONDS, DeviceRequest
from ..cluster.versions import describe_versions, find_version_fault
from ..errors import DeviceError, GraphError, HalationError, InputError, UsageError
from ..graph.paths import change_paths, resolve_path
from ..regression.cluster_cases import run_case_text
from ..renderer.jobs.pipeline import KeptResults
from ..renderer.jobs.source_files import FileHashes
from ..resources.input_files import content_hash, fingerprint
from ..resources.struct_json import read_struct
from . import parsing
from .execute_batch import make_entry_item, open_entry_graph
from .job_setup import choose_budget, describe_costs, make_output_settings, make_request, open_job_device
from .outcome import INTERRUPTED, describe_fault
from .part_lines import FrameLines, PartLines

if TYPE_CHECKING:
    from ..cluster.chunk import ChunkStage
    from ..graph import Graph, Port
    from ..renderer import Renderer
    from ..renderer.execution.texture_pool import TexturePool
    from ..renderer.jobs.item_session import JobItem, SharedHistory
    from ..renderer.jobs.render_job import RenderJob
    from ..renderer.jobs.reports import ItemReport, JobReport
    from ..resources.sandbox import Sandbox

_PIECE_BYTES = 1 << 16
"""Bytes that are read at once at most: as many as a pipe holds."""

_POINTLESS = (UsageError, GraphError)
"""Errors that all frames of a job have alike."""


def render_chunks(sandbox: Sandbox) -> int:
    """Render the chunks that are read from standard input until it ends, or none comes for some time.

    Files outside of `sandbox` are refused, whatever a chunk says.
    """
    _load_modules()
    with tempfile.TemporaryDirectory(prefix="halation-") as folder:
        renderer = ChunkRenderer(Path(folder), _write_line, sandbox)
        try:
            for line in _read_lines():
                if line.startswith('{"case"'):
                    _write_line(run_case_text(line))
                elif line.startswith('{"device"'):
                    renderer.open_device(read_struct(line, DeviceRequest).device)
                else:
                    renderer.render(FrameChunk.from_json(line))
        except KeyboardInterrupt:  # the job is cancelled, and who cancels it says so
            return INTERRUPTED
    return 0


def _load_modules() -> None:
    """Import what every chunk needs, while the first one is still on its way."""
    for name in ("document", "renderer.jobs.job", "renderer.opengl.device", "media"):
        import_module(f"..{name}", __package__)


def _read_lines() -> Iterator[str]:
    """The lines of standard input, until it ends or none comes for some time.

    It is read without a buffer: lines that lie in one already would not end a wait.
    """
    source, rest = sys.stdin.fileno(), b""
    while sys.platform == "win32" or select.select([source], [], [], IDLE_SECONDS)[0]:
        piece = os.read(source, _PIECE_BYTES)
        if not piece:
            return
        *lines, rest = (rest + piece).split(b"\n")
        for line in lines:
            yield line.decode("utf-8")


def _write_line(facts: Mapping[str, Any]) -> None:
    print(json.dumps(facts), flush=True)


class ChunkRenderer:
    """Renders chunks with one device. `folder` is for small files that travel with chunks; `write_line` answers."""

    def __init__(self, folder: Path, write_line: Callable[[Mapping[str, Any]], None], sandbox: Sandbox) -> None:
        self._folder, self._write_line, self._sandbox = folder, write_line, sandbox
        self._file_hashes = FileHashes(sandbox=sandbox)
        self._topic, self._kept = "", KeptResults()
        self._renderer: Renderer | None = None
        self._last_graph: tuple[tuple[str, str], Graph] | None = None
        self._hashes: dict[str, str] = {}
        self._wrong_file = ""
        """The file that was compared last."""

    def open_device(self, job: RenderJob) -> None:
        """Open the device that chunks of a job need. Where that fails, they try again and say so."""
        with contextlib.suppress(DeviceError):
            self._open_renderer(self._localize_job(job, PathMap(())))

    def render(self, chunk: FrameChunk) -> None:
        """Render a chunk and answer: a line for each frame, then one for all, or one that this machine cannot."""
        paths = PathMap(chunk.path_map)
        try:
            chunk = replace(chunk, job=self._localize_job(chunk.job, paths))
            if chunk.job.sandbox.root:  # what travels would lie outside of it
                chunk = replace(chunk, contents={})
            graph = self._open_graph(chunk, paths)
            if fault := find_version_fault(describe_versions(graph), chunk.versions):
                self._write_line({"refusal": fault})
                return
            renderer = self._open_renderer(chunk.job)
            self._renew_job(chunk, renderer.runner.textures, graph)
            if faults := self._check_files(chunk, graph, paths):
                self._write_line({"faults": faults, "costs": {}})
                return
            if chunk.numbers:
                self._render_entries(chunk, graph, renderer, paths)
                return
            graph, history = self._locate_files(chunk, graph, paths), self._open_history(chunk, paths)
            if history is not None and chunk.stage is not None and chunk.stage.frames:
                self._render_stage(chunk, chunk.stage, self._make_item(chunk, graph, chunk.job.frames, history))
            else:
                self._render_frames(chunk, graph, renderer, history)
        except DeviceError as fault:
            self._write_line({"refusal": f"it cannot render: {fault}"})
        except HalationError as fault:
            self._write_line({"faults": _spread_fault(chunk, fault), "costs": {}})

    def _render_stage(self, chunk: FrameChunk, stage: ChunkStage, item: JobItem) -> None:
        """Render a stage that comes before the frames."""
        from ..renderer.jobs.item_session import ItemSession
        from .chunk_stages import StageRenderer

        assert self._renderer is not None and item.history is not None
        session = ItemSession(self._renderer, item, chunk.job.document, self._file_hashes, chunk.job.resume)
        try:
            stage_renderer = StageRenderer(self._renderer, session, item.history.results, stage)
            stage_renderer.render()
        finally:
            session.abort()
        self._write_line({"faults": stage_renderer.faults, "costs": {}, "stage": to_builtins(stage_renderer.report)})

    def _render_frames(
        self, chunk: FrameChunk, graph: Graph, renderer: Renderer, history: SharedHistory | None
    ) -> None:
        """Render the frames together, and after an error those that are missing one by one, to find the faulty ones."""
        faults, costs = dict[int, Mapping[str, Any]](), dict[str, Any]()
        pieces = [chunk.job.frames]
        while pieces:
            frames = pieces.pop(0)
            item = self._make_item(chunk, graph, frames, history)
            finished, fault, costs = self._run(renderer, item, chunk)
            missing = [frame for frame in frames if frame not in finished]
            if fault is None:
                continue
            if len(missing) == 1 or chunk.is_chain or isinstance(fault, _POINTLESS):
                faults |= dict.fromkeys(missing, describe_fault(fault))
            else:
                pieces += [(frame,) for frame in missing]
        self._write_line({"faults": faults, "costs": costs})

    def _render_entries(self, chunk: FrameChunk, graph: Graph, renderer: Renderer, paths: PathMap) -> None:
        """Render files. One that fails ends no other."""
        from ..renderer.jobs.job import run_batch

        targets = parsing.find_targets(graph, chunk.job.node)
        faults, outcomes = dict[str, Mapping[str, Any]](), dict[str, EntryOutcome]()
        lines = PartLines(self._write_line)

        def report_item(report: ItemReport) -> None:
            passes = sum(frame.passes for frame in report.frames)
            outcome = EntryOutcome(tuple(frame.frame for frame in report.frames), passes)
            if report.fault is not None:
                faults[report.name], outcomes[report.name] = describe_fault(report.fault), outcome
                return
            is_kept = all(frame.is_kept for frame in report.frames)
            lines.write(int(report.name), passes, is_kept=is_kept, entry=to_builtins(outcome))

        items = (
            (str(number), partial(self._open_entry, chunk, graph, number, paths, targets)) for number in chunk.numbers
        )
        report = run_batch(
            renderer,
            items,
            report_item,
            resume=chunk.job.resume,
            hashes=self._file_hashes,
            kept=self._kept,
        )
        costs = _describe_costs(report, renderer)
        self._write_line({"faults": faults, "costs": costs, "entries": to_builtins(outcomes)})

    def _open_entry(
        self, chunk: FrameChunk, graph: Graph, number: int, paths: PathMap, targets: Mapping[str, Port]
    ) -> JobItem:
        """What is rendered for one file. Raises HalationError."""
        from ..renderer.jobs.header import dump_whole_graph

        (entry,) = chunk.take_parts((number,)).job.entries
        graph = open_entry_graph(graph, entry)
        text = dump_whole_graph(graph) if entry.sets else chunk.job.document
        item = make_entry_item(chunk.job, self._locate_files(chunk, graph, paths), entry, targets)
        return replace(item, name=str(number), graph_text=text)

    def _run(
        self, renderer: Renderer, item: JobItem, chunk: FrameChunk
    ) -> tuple[set[int], HalationError | None, dict[str, Any]]:
        """Render an item: the frames that are finished, the error if there is one, and what it took."""
        from ..renderer.jobs.job import run_batch

        reports: list[ItemReport] = []
        progress = FrameLines(PartLines(self._write_line))
        report = run_batch(
            renderer,
            [("", lambda: item)],
            reports.append,
            resume=chunk.job.resume,
            progress=progress,
            hashes=self._file_hashes,
            kept=self._kept,
        )
        frames = {frame.frame for frame in report.frames}
        return frames, reports[0].fault, _describe_costs(report, renderer)

    # --- what the machine has ----------------------------------------------------------------------------------------

    def _open_graph(self, chunk: FrameChunk, paths: PathMap) -> Graph:
        """The graph of a chunk, which is read only if it is another one than that of the chunk before."""
        from ..document import loads

        key = (chunk.job.document, paths.locate(chunk.folder))
        if self._last_graph is None or self._last_graph[0] != key:
            self._last_graph = key, loads(*key[:1], "-", key[1], sandbox=chunk.job.sandbox)
        return self._last_graph[1]

    def _open_renderer(self, job: RenderJob) -> Renderer:
        from ..renderer import Renderer

        if self._renderer is None:
            self._renderer = Renderer(open_job_device(job), sandbox=job.sandbox)
        return self._renderer

    def _renew_job(self, chunk: FrameChunk, textures: TexturePool, graph: Graph) -> None:
        """Keep the hashes of files, and the results that all frames share, for all chunks of a job."""
        textures.budget = choose_budget(chunk.job, graph)
        if self._topic != chunk.topic:
            self._file_hashes.close()
            self._kept.replace(None)
            textures.peak = textures.allocated
            self._topic, self._file_hashes = chunk.topic, FileHashes(sandbox=chunk.job.sandbox)

    def _localize_job(self, job: RenderJob, paths: PathMap) -> RenderJob:
        """The job with paths of this machine, in the sandbox of this process."""
        sandbox = self._sandbox
        return replace(
            job,
            inputs={name: paths.locate(file) for name, file in job.inputs.items()},
            destinations=_localize_files(job.destinations, paths),
            entries=tuple(
                replace(
                    entry,
                    inputs={name: paths.locate(file) for name, file in entry.inputs.items()},
                    destinations=_localize_files(entry.destinations, paths),
                )
                for entry in job.entries
            ),
            sandbox=sandbox.narrow(paths.locate(job.sandbox.root)) if job.sandbox.root else sandbox,
        )

    def _check_files(self, chunk: FrameChunk, graph: Graph, paths: PathMap) -> dict[int, Mapping[str, Any]]:
        """What is wrong with the files of a chunk, by frame; of a chain it says which frame reads the first such file.

        Raises HalationError for what cannot be told apart.
        """
        from ..cluster.file_marks import FileMarker

        try:
            self._compare_files(chunk, paths)
        except HalationError as fault:
            if not chunk.is_chain:
                raise
            marker = FileMarker(self._locate_files(chunk, graph, paths), chunk.job.inputs, chunk.job.sandbox)
            readers = [frame for frame in chunk.job.frames if self._wrong_file in marker.list_files((frame,), range(0))]
            facts = {**describe_fault(fault), "frame": min(readers, default=chunk.job.frames[0])}
            return dict.fromkeys(chunk.job.frames, facts)
        return {}

    def _compare_files(self, chunk: FrameChunk, paths: PathMap) -> None:
        """Raise InputError for a file that is not the one that the job was sent with; note which it is."""
        for path, mark in chunk.marks.items():
            if path in chunk.contents:
                continue
            file = self._wrong_file = paths.locate(path)
            version = fingerprint(file, chunk.job.sandbox)
            size = Path(file).stat().st_size
            if size == mark.size and version not in self._hashes:
                self._hashes[version] = content_hash(file, chunk.job.sandbox)
            digest = self._hashes[version] if size == mark.size else ""
            if digest != mark.digest:
                facts = f"SHA-256 {digest[:12]}, not {mark.digest[:12]}" if digest else f"{size} bytes, not {mark.size}"
                raise InputError(
                    f"{file}: is another file than on the machine that sent the job (it has {facts}): copy it here, or "
                    "name its folder with --map"
                )

    def _locate_files(self, chunk: FrameChunk, graph: Graph, paths: PathMap) -> Graph:
        """The graph with the paths that files have on this machine, and with those that have travelled."""

        def locate(text: str) -> str:
            path = str(resolve_path(text, chunk.folder))
            if path in chunk.contents:
                return str(self._store_content(chunk, path))
            located = paths.locate(path)
            return text if located == str(resolve_path(text, graph.folder)) else located

        return change_paths(graph, locate) if chunk.path_map or chunk.contents else graph

    def _store_content(self, chunk: FrameChunk, path: str) -> Path:
        """A file that has travelled with a chunk, under its own name."""
        file = self._folder / chunk.marks[path].digest / os.path.basename(path)  # noqa: PTH119 - of another system
        if not file.is_file():
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(base64.b64decode(chunk.contents[path]))
        return file

    def _open_history(self, chunk: FrameChunk, paths: PathMap) -> SharedHistory | None:
        """What other workers have rendered of the job, without what nobody needs any more."""
        from ..renderer.jobs.item_session import SharedHistory
        from ..renderer.jobs.shared_results import SharedResults

        if chunk.stage is None:
            return None
        folder = Path(paths.locate(chunk.stage.folder))
        results = SharedResults(folder, self._file_hashes.hash_file, chunk.job.sandbox)
        results.remove_files(chunk.stage.drops)
        return SharedHistory(results, chunk.stage.frame_before, chunk.stage.memories)

    def _make_item(
        self, chunk: FrameChunk, graph: Graph, frames: Sequence[int], history: SharedHistory | None
    ) -> JobItem:
        from ..renderer.jobs.item_session import JobItem

        job = chunk.job
        targets = parsing.find_targets(graph, job.node)
        request, settings = make_request(job, job.inputs, targets), make_output_settings(job, job.files)
        return JobItem("", graph, request, settings, tuple(frames), graph_text=job.document, history=history)


def _spread_fault(chunk: FrameChunk, fault: HalationError) -> dict[int, Mapping[str, Any]]:
    """An error of a chunk by its parts.

    Of several, which each may read another file, the sender sends each alone to find the faulty one.
    """
    is_clear = len(chunk.parts) == 1 or chunk.is_chain or isinstance(fault, _POINTLESS)
    return dict.fromkeys(chunk.parts, describe_fault(fault)) if is_clear else {}


def _localize_files(destinations: Sequence[tuple[str, str]], paths: PathMap) -> tuple[tuple[str, str], ...]:
    return tuple((name, paths.locate(file)) for name, file in destinations)


def _describe_costs(report: JobReport, renderer: Renderer) -> dict[str, Any]:
    """What a chunk has cost, ready for JSON."""
    costs = describe_costs(report, renderer.device.description)
    return {**costs, "seconds": {name: round(part, 4) for name, part in report.seconds.items()}}

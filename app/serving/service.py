"""Answers the requests of clients with one renderer."""

from __future__ import annotations

import base64
import json
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct
from msgspec.structs import replace

from ..compiler.planner import MAX_REMEMBERED_PLANS
from ..custom_nodes.plugins import find_graph_or_preset
from ..document import load, loads
from ..errors import RenderError, UsageError
from ..graph import Expression, Graph
from ..resources.sandbox import UNRESTRICTED, Sandbox
from ..scripting.arguments import (
    check_binding,
    check_frame_number,
    check_scale,
    check_size,
    check_target,
)
from ..scripting.array_file import ArrayFile, open_array_file
from ..scripting.packed_arrays import pack_array, unpack_array
from .request_queue import ServiceClient
from .service_requests import ServiceRequest, describe_failure

if TYPE_CHECKING:
    from ..compiler import Plan
    from ..renderer import FrameRenderer, Renderer, RenderRequest
    from ..renderer.execution.decoding import Array
    from ..renderer.jobs.reports import FrameReport

Answer = Callable[[ServiceRequest, Callable[..., None]], dict[str, Any]]
"""Makes a reply; it calls its second argument between two passes."""

_MAX_THUMBNAIL_WIDTH = 2048
"""Pixels of a thumbnail. Chosen by judgement: larger pictures go by file."""


class ServiceLimits(Struct, frozen=True):
    """What one request may take: seconds, 0 for any number, and pixels of each picture that is computed for it."""

    seconds: float = 60.0
    pixels: int = 2**26


class RequestCancelled(Exception):
    """The client has gone, or no longer needs the reply."""


class RenderService:
    """Answers requests, one at a time, on the thread that has opened the renderer."""

    def __init__(self, renderer: Renderer, sandbox: Sandbox, limits: ServiceLimits) -> None:
        self._renderer, self._sandbox, self._limits = renderer, sandbox, limits
        self._recent_graphs: list[Graph] = []
        """As they were loaded, the newest first."""

    def answer(self, client: ServiceClient, request: ServiceRequest) -> None:
        """Send the reply to a request, which may be an error; none to a client that has gone."""
        started = time.monotonic()

        def check_request(*_: object) -> None:
            """Raise where a request may not go on; called between two passes."""
            if client.is_gone or request.id in client.cancelled_ids:
                raise RequestCancelled
            if 0.0 < self._limits.seconds < time.monotonic() - started:
                raise RenderError(
                    f"the request takes more than {self._limits.seconds:g} seconds: render a smaller picture with "
                    "scale or size, or start the server with a larger --limit"
                )

        try:
            check_request()
            reply = self._choose_answer(request)(request, check_request)
        except RequestCancelled:
            client.cancelled_ids.discard(request.id)
            if not client.is_gone:
                client.send({"id": request.id, "cancelled": True})
            return
        except Exception as fault:
            reply = {"error": describe_failure(fault)}
        client.send({"id": request.id, **reply})

    def _choose_answer(
        self, request: ServiceRequest
    ) -> Callable[[ServiceRequest, Callable[..., None]], dict[str, Any]]:
        if request.action == "render":
            return self._write_files if request.output else self._render_pixels
        return {"thumbnail": self._make_thumbnail, "explain": self._explain, "check": self._check}[request.action]

    # --- what can be asked for ---------------------------------------------------------------------------------------

    def _render_pixels(self, request: ServiceRequest, check_request: Callable[..., None]) -> dict[str, Any]:
        """The pixels of all outputs."""
        graph = self._open_graph(request)
        with self._open_array_file(request) as array_file:
            render_request = self._make_render_request(graph, request, array_file)
            pictures = self._render(graph, render_request, request.frame, check_request)[1]
            pack = pack_array if array_file is None else array_file.pack_array
            return {"pictures": {name: pack(array) for name, array in pictures.items()}}

    def _write_files(self, request: ServiceRequest, check_request: Callable[..., None]) -> dict[str, Any]:
        """Write the outputs to files, as `halation render` does."""
        from ..renderer import FrameRenderer
        from ..renderer.jobs.job import OutputSettings, run_job

        graph = self._open_graph(request)
        render_request = self._make_render_request(graph, request)
        frame_renderer = FrameRenderer(self._renderer, graph, render_request)
        frame = self._choose_frame(frame_renderer, request.frame, check_request)
        frame_renderer.close()
        files = tuple((name, Path(path)) for name, path in request.output.items())
        settings = OutputSettings(files, request.view, precision=request.precision or "half")
        report = run_job(
            self._renderer, graph, render_request, settings, (frame,), progress=_PassWatcher(check_request)
        )
        return {"written": [str(path) for path in report.written]}

    def _make_thumbnail(self, request: ServiceRequest, check_request: Callable[..., None]) -> dict[str, Any]:
        """A small PNG of the first output, as base64.

        A frame is planned at full size first, because only the plan knows how wide the picture is; then it is rendered
        at the scale that gives the requested width.
        """
        from halation.nodes import Kind

        from .. import media
        from ..color.encoding import Encoding
        from ..inputs.default_view import choose_default_view
        from ..renderer import FrameRenderer

        if not 1 <= request.width <= _MAX_THUMBNAIL_WIDTH:
            raise UsageError(f"width {request.width}: a thumbnail has 1 to {_MAX_THUMBNAIL_WIDTH} pixels")
        graph = self._open_graph(request)
        full_request = self._make_render_request(graph, request)
        frame_renderer = FrameRenderer(self._renderer, graph, full_request)
        full_plan = frame_renderer.plan_frame(self._choose_frame(frame_renderer, request.frame, check_request))
        frame_renderer.close()
        name = next(iter(full_plan.outputs))
        full_width = full_plan.surfaces[full_plan.outputs[name]].size[0]
        small_request = replace(full_request, scale=min(1.0, full_request.scale * request.width / full_width))
        plan, pictures = self._render(graph, small_request, request.frame, check_request)
        view = request.view or choose_default_view(plan, plan.outputs[name], self._renderer.pictures)
        array = pictures[name]
        kind = Kind.IMAGE if array.shape[2] >= 3 else Kind.FIELD
        with tempfile.TemporaryDirectory(prefix="halation-") as folder:
            file = Path(folder, "thumbnail.png")
            layers = {"image": array if kind is Kind.IMAGE else array[..., :1]}
            media.write_picture(file, layers, kinds={"image": kind}, encoding=Encoding(view), sandbox=UNRESTRICTED)
            png = base64.b64encode(file.read_bytes()).decode("ascii")
        return {"output": name, "size": [array.shape[1], array.shape[0]], "png": png}

    def _explain(self, request: ServiceRequest, check_request: Callable[..., None]) -> dict[str, Any]:
        """The plan, as `halation explain --json` prints it."""
        from ..compiler import plan_as_json
        from ..renderer import FrameRenderer

        graph = self._open_graph(request)
        frame_renderer = FrameRenderer(self._renderer, graph, self._make_render_request(graph, request))
        try:
            return {
                "plan": plan_as_json(
                    frame_renderer.plan_frame(self._choose_frame(frame_renderer, request.frame, check_request))
                )
            }
        finally:
            frame_renderer.close()

    def _check(self, request: ServiceRequest, check_request: Callable[..., None]) -> dict[str, Any]:
        """The problems of a graph, as `halation check --json` prints them."""
        from ..lint.checking import GraphChecker

        checker = GraphChecker(self._sandbox)
        if isinstance(request.graph, str):
            report = checker.check_file(find_graph_or_preset(request.graph))
        else:
            report = checker.check_text(json.dumps(request.graph, indent=2), "-", "")
        return {"problems": [finding.facts for finding in report.findings], "exit_code": report.code}

    # --- parts -------------------------------------------------------------------------------------------------------

    def _open_graph(self, request: ServiceRequest) -> Graph:
        """The graph of a request with its values. Raises HalationError."""
        if not request.graph:
            raise UsageError("graph: name a graph file or a preset, or give a graph as JSON")
        graph = (
            load(find_graph_or_preset(request.graph), sandbox=self._sandbox)
            if isinstance(request.graph, str)
            else loads(json.dumps(request.graph), "-", sandbox=self._sandbox)
        )
        graph = self._recall_graph(graph)
        for name, setting in request.set.items():
            is_expression = isinstance(setting, str) and setting.startswith("=")
            graph = graph.override(name, Expression(setting[1:].strip()) if is_expression else setting)
        return graph

    def _recall_graph(self, graph: Graph) -> Graph:
        """The same graph as an earlier request had it: a plan follows that of a graph with the same parts."""
        recent = self._recent_graphs
        known = next((old for old in recent if old == graph and old.folder == graph.folder), graph)
        self._recent_graphs = [known, *(old for old in recent if old is not known)][:MAX_REMEMBERED_PLANS]
        return known

    def _open_array_file(self, request: ServiceRequest) -> AbstractContextManager[ArrayFile | None]:
        """The file for arrays that a request names, if it names one. Raises OutputError when it is entered."""
        return open_array_file(request.array_file, self._sandbox) if request.array_file else nullcontext()

    def _make_render_request(
        self, graph: Graph, request: ServiceRequest, array_file: ArrayFile | None = None
    ) -> RenderRequest:
        """What is rendered, from arguments that are checked as those of Python are."""
        from ..renderer import RenderRequest

        inputs = {
            name: unpack_array(name, binding, array_file) if isinstance(binding, dict) else check_binding(name, binding)  # pyright: ignore[reportUnknownArgumentType]
            for name, binding in request.input.items()
        }
        targets, size = check_target(graph, request.node), check_size(request.size)
        return RenderRequest(inputs, targets, size, check_scale(request.scale), precision=request.precision)

    def _render(
        self, graph: Graph, render_request: RenderRequest, frame: int | None, check_request: Callable[..., None]
    ) -> tuple[Plan, dict[str, Array]]:
        """A frame with the history that it needs: its plan and its outputs."""
        from ..renderer import FrameRenderer

        frame_renderer = FrameRenderer(self._renderer, graph, render_request)
        lease = self._renderer.runner.create_lease()
        try:
            chosen_frame = self._choose_frame(frame_renderer, frame, check_request)
            for run in frame_renderer.start_runs(chosen_frame, lease):
                with run:
                    for _ in run:
                        check_request()
            plan = frame_renderer.plan_frame(chosen_frame)
            return plan, self._renderer.runner.download(plan)
        finally:
            lease.close()
            frame_renderer.close()

    def _choose_frame(
        self, frame_renderer: FrameRenderer, frame: int | None, check_request: Callable[..., None]
    ) -> int:
        """The frame of a request, by default the first, if its pictures are not too large; it is planned.

        Raises HalationError.
        """
        chosen_frame = frame_renderer.frames[0] if frame is None else check_frame_number(frame)
        while frame_renderer.plan_next(chosen_frame):  # a frame with a long history takes long to plan
            check_request()
        most = self._limits.pixels
        for surface in frame_renderer.plan_frame(chosen_frame).surfaces:
            width, height = surface.size
            if 0 < most < width * height:
                raise UsageError(
                    f"a picture of {width}x{height} has more than the {most:,} pixels that a request may have: render "
                    "a smaller one with scale or size, or start the server with a larger --max-pixels"
                )
        return chosen_frame


class _PassWatcher:
    """Calls a function between two passes of a job."""

    def __init__(self, check_request: Callable[..., None]) -> None:
        self._check_request = check_request

    def report_pass(self, frame: int, passes_done: int, total: int, nodes: Sequence[str]) -> None:
        """Look whether the request may go on."""
        self._check_request()

    def report_frame(self, report: FrameReport, frames_done: int, total: int) -> None:
        """Nothing: the reply says what is written."""

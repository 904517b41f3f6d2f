"""`halation serve`: a warm process that renders for other programs."""

from __future__ import annotations

import contextlib
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import Form, Memory
from .outcome import INTERRUPTED, print_note
from .watchdog import Timeout, run_service, run_stream_service

if TYPE_CHECKING:
    from ..serving.service import ServiceLimits


def serve(
    socket: Annotated[
        Path | None,
        typer.Option(
            "--socket", metavar="FILE", help="Listen at this local socket; by default to standard input and output."
        ),
    ] = None,
    limit: Annotated[
        float, typer.Option("--limit", min=0.0, metavar="SECONDS", help="The longest that a request may take.")
    ] = 60.0,
    max_pixels: Annotated[
        int, typer.Option("--max-pixels", min=0, metavar="N", help="The most pixels of a picture in a request.")
    ] = 2**26,
    form: Form = None,
    memory: Memory = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: Annotated[bool, typer.Option("--json", help="Print an error as JSON too; replies always are.")] = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Answer requests in lines of JSON.

    It ends with the input, or on Ctrl-C. A request is {"id": 1, "do": "render", "graph": "look.json", "set":
    {"blur.sigma": 4}}; it may also be to explain, check or make a thumbnail. The device and its programs stay from
    request to request.
    """
    from ..serving.service import ServiceLimits

    form_of_passes, memory_limit = parsing.parse_form(form), parsing.parse_memory(memory)

    def work() -> int:
        return _serve(socket, form_of_passes, memory_limit, ServiceLimits(limit, max_pixels), sandbox)

    return (run_stream_service if socket is None else run_service)(work, timeout, as_json)


def _serve(path: Path | None, form: parsing.Form | None, memory: int, limits: ServiceLimits, sandbox: Sandbox) -> int:
    """Open the device and answer requests in this process."""
    from ..renderer import Renderer, open_device
    from ..serving.listening import serve_socket, serve_stream
    from ..serving.request_queue import RequestQueue
    from ..serving.service import RenderService

    queue = RequestQueue()
    with contextlib.ExitStack() as stack:
        if path is not None:
            stack.enter_context(serve_socket(queue, path, sandbox))
        renderer = Renderer(open_device(form, memory, sandbox=sandbox), sandbox=sandbox)
        stack.callback(renderer.close)
        if path is None:
            # Whatever a library prints must not get between the replies.
            replies = stack.enter_context(os.fdopen(os.dup(sys.stdout.fileno()), "wb"))
            os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
            serve_stream(queue, sys.stdin.buffer, replies)
        service = RenderService(renderer, sandbox, limits)
        try:
            print_note(f"{renderer.device.description}; ready{'' if path is None else f' at {path}'}")
            while (turn := queue.take_request()) is not None:
                service.answer(*turn)
        except KeyboardInterrupt:
            return INTERRUPTED if path is None else 0
    return 0

"""`halation thumbnail`: a small picture of a file, for file managers (see the `desktop` room)."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from ..resources.sandbox import Sandbox
from .watchdog import run_session

_SECONDS = 20.0
"""The longest that a thumbnail may take: chosen by judgement, as file managers wait with the whole folder."""

_PIXELS = 2**24
"""Pixels of each picture on the way, 4096 x 4096: a graph in a folder of downloads shall not fill the memory."""


def thumbnail(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A graph file (JSON) or a picture.")],
    picture: Annotated[Path, typer.Argument(metavar="PNG", help="The file to write.")],
    size: Annotated[int, typer.Option(min=1, max=2048, metavar="PIXELS", help="The longer side.")] = 256,
) -> int:
    """Write a small picture of a graph's first output, or of a picture.

    Other files are read only from the folder of the graph and below, because file managers make thumbnails of whatever
    lies in a folder.
    """
    sandbox = Sandbox(str(file.absolute().parent))
    if file.suffix.lower() == ".json":
        return run_session(lambda: _write_graph(file, picture, size, sandbox), _SECONDS, False)
    from ..media.pictures.thumbnail import read_thumbnail, save_thumbnail
    from ..resources.sandbox import UNRESTRICTED

    save_thumbnail(picture, read_thumbnail(file, size, size, sandbox), UNRESTRICTED)
    return 0


def _write_graph(file: Path, picture: Path, size: int, sandbox: Sandbox) -> int:
    from ..errors import rebuild_fault
    from ..renderer import Renderer, open_device
    from ..resources.atomic_write import write_bytes_atomically
    from ..resources.sandbox import UNRESTRICTED
    from ..serving.request_queue import ServiceClient
    from ..serving.service import RenderService, ServiceLimits
    from ..serving.service_requests import ServiceRequest

    replies: list[Mapping[str, Any]] = []
    renderer = Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
    service = RenderService(renderer, sandbox, ServiceLimits(_SECONDS, _PIXELS))
    service.answer(ServiceClient(replies.append), ServiceRequest("thumbnail", graph=str(file), width=size))
    (reply,) = replies
    if error := reply.get("error"):
        raise rebuild_fault(error)
    write_bytes_atomically(picture, base64.b64decode(reply["png"]), sandbox=UNRESTRICTED)
    return 0

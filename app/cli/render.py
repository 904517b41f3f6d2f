"""`halation render`: a graph in, finished pictures out."""

from __future__ import annotations

from typing import Annotated

import typer

from ..errors import UsageError
from ..resources.render_choices import DEFAULT_TIMEOUT
from . import parsing
from .execute import execute
from .options import (
    AsJson,
    Form,
    Frames,
    GraphFile,
    Inputs,
    Memory,
    Node,
    OneFrame,
    Precision,
    Scale,
    Sets,
    SizeText,
    standard_input,
)
from .watchdog import Timeout


def render(
    graph: GraphFile,
    output: Annotated[
        list[str],
        typer.Option("-o", "--output", metavar="[NAME=]FILE", help="Where to write; .exr holds all outputs as layers."),
    ],
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: OneFrame = None,
    frames: Frames = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Keep frames whose files are there and would come out the same.")
    ] = False,
    jobs: Annotated[
        int, typer.Option("-j", "--jobs", min=1, help="Processes that share the frames, where these are independent.")
    ] = 1,
    precision: Precision = None,
    memory: Memory = None,
    view: Annotated[
        str, typer.Option(help="OpenColorIO view for PNG, JPEG, TIFF, WebP and DPX; 'none' for plain sRGB.")
    ] = "",
    display: Annotated[str, typer.Option(help="OpenColorIO display for those; by default that of the config.")] = "",
    look: Annotated[
        str, typer.Option(help="OpenColorIO look for those, in place of the looks of the view; 'none' for no look.")
    ] = "",
    colorspace: Annotated[
        str, typer.Option(metavar="NAME", help="Write the numbers of a color space, such as ACEScg, into any format.")
    ] = "",
    compression: Annotated[
        str, typer.Option(help="EXR compression: none, rle, zips, zip, piz, pxr24, dwaa, ...")
    ] = "zip",
    codec: Annotated[
        str, typer.Option(help="Of videos: h264, h265, prores, prores4444, ffv1, qtrle, vp9; by default by the ending.")
    ] = "",
    form: Form = None,
    deterministic: Annotated[
        bool, typer.Option("--deterministic", help="The same bytes on every machine: the software rasterizer, pinned.")
    ] = False,
    progress: Annotated[
        str, typer.Option(metavar="bar|json", help="A bar, on a terminal only, or a JSON object per pass and frame.")
    ] = "bar",
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
) -> int:
    """Render a graph to files: one frame, or many.

    An output whose name holds a place for the frame number (shot.####.png, shot.%04d.png) asks for all frames of the
    graph unless some are named.
    """
    form_of_passes = parsing.form(form) if form is not None else None
    if deterministic and form_of_passes == "compute":
        raise UsageError("--deterministic renders with fragment passes: leave out --form compute")
    from ..renderer.jobs.render_job import RenderJob
    from ..resources.sandbox import sandbox_root

    job = RenderJob(
        graph=str(graph),
        document=standard_input() if str(graph) == "-" else "",
        inputs=parsing.inputs(inputs),
        sets=parsing.sets(sets),
        node=node,
        size=parsing.size(size),
        scale=parsing.scale(scale),
        frames=parsing.frames(frame, frames) or (),
        precision=parsing.precision(precision) if precision is not None else None,
        form=form_of_passes,
        memory=parsing.memory(memory),
        deterministic=deterministic,
        destinations=tuple((name, str(path)) for name, path in parsing.paths(output)),
        view=view,
        display=display,
        look=look,
        colorspace=colorspace,
        compression=compression,
        codec=codec,
        resume=resume,
        processes=jobs,
        timeout=timeout,
        root=sandbox_root(),
    )
    return execute(job, parsing.progress(progress), as_json)

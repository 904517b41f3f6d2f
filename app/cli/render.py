"""`halation render`: renders a graph to files."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import UsageError
from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .execute import execute
from .options import (
    AsJson,
    Cluster,
    Form,
    Frames,
    GraphFile,
    Inputs,
    Memory,
    Node,
    OneFrame,
    Outputs,
    PathMaps,
    Precision,
    Scale,
    Sets,
    SizeText,
    View,
    read_standard_input,
)
from .watchdog import Timeout

if TYPE_CHECKING:
    from ..renderer.jobs.render_entry import RenderEntry


_Output = Annotated[list[str] | None, Outputs]
_Each = Annotated[
    list[str] | None,
    typer.Option(
        "--each",
        metavar="FILE|PATTERN|@LIST|-",
        help="Render once for each of these files, which {} and {stem} in -i, --set and -o stand for.",
    ),
]
_Resume = Annotated[bool, typer.Option("--resume", help="Skip frames whose files exist and are up to date.")]
_Jobs = Annotated[
    str,
    typer.Option(
        "-j",
        "--jobs",
        metavar="N|auto",
        help="Share the frames among this many processes, if each frame is independent; auto measures how many pay.",
    ),
]
_Priority = Annotated[
    int, typer.Option("--priority", help="Frames of jobs with a higher number go first on a cluster.")
]
_Detach = Annotated[
    bool,
    typer.Option("--detach", help="Leave the job to the cluster; halation jobs lists, follows and cancels it."),
]
_Display = Annotated[str, typer.Option(help="OpenColorIO display of these files; by default that of the config.")]
_Look = Annotated[
    str, typer.Option(help="OpenColorIO look of these files, instead of the looks of the view; 'none' for no look.")
]
_Colorspace = Annotated[
    str, typer.Option(metavar="NAME", help="Write colors in this color space, such as ACEScg, in any format.")
]
_Compression = Annotated[str, typer.Option(help="EXR compression: none, rle, zips, zip, piz, pxr24, dwaa, ...")]
_Codec = Annotated[
    str,
    typer.Option(
        help="Codec of videos: h264, h265, prores, prores4444, ffv1, qtrle or vp9; the default depends on the file."
    ),
]
_Dither = Annotated[
    str,
    typer.Option(
        metavar="blue|none",
        help="Round colors to 8 and 10 bits with blue noise, which prevents bands, or to the nearest code.",
    ),
]
_BurnIn = Annotated[
    bool, typer.Option("--burn-in", help="Write the file, timecode and frame over the pictures, for dailies.")
]
_Deterministic = Annotated[
    bool,
    typer.Option(
        "--deterministic",
        help="Give the same bytes on every machine: render with one fixed version of the software rasterizer.",
    ),
]
_Progress = Annotated[
    str,
    typer.Option(metavar="bar|json", help="Show a bar (on terminals only), or print a JSON object per pass and frame."),
]


def render(
    graph: GraphFile,
    output: _Output = None,
    each: _Each = None,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: OneFrame = None,
    frames: Frames = None,
    resume: _Resume = False,
    jobs: _Jobs = "1",
    cluster: Cluster = "",
    path_map: PathMaps = None,
    priority: _Priority = 0,
    detach: _Detach = False,
    precision: Precision = None,
    memory: Memory = None,
    view: View = "",
    display: _Display = "",
    look: _Look = "",
    colorspace: _Colorspace = "",
    compression: _Compression = "zip",
    codec: _Codec = "",
    dither: _Dither = "blue",
    burn_in: _BurnIn = False,
    form: Form = None,
    deterministic: _Deterministic = False,
    progress: _Progress = "bar",
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Render a graph to files: one frame, or many.

    A file name with a place for the frame number (shot.####.png, shot.%04d.png) renders all frames of the graph, unless
    --frame or --frames chooses some. --each 'photos/*.jpg' -o 'graded/{stem}.png' renders many files.
    """
    _check_files(graph, output, each)
    _check_picture(deterministic, parsing.parse_form(form), burn_in, node)
    if (path_map or priority or detach) and not cluster:
        raise UsageError("--map, --priority and --detach are for a cluster: write --cluster ADDRESS too")
    from ..renderer.jobs.render_job import RenderJob

    files, settings = parsing.parse_inputs(inputs), parsing.parse_sets(sets)
    destinations = parsing.parse_destinations(output or ())
    entries: tuple[RenderEntry, ...] = ()
    if each:
        entries, settings = _expand_each(each, files, settings, destinations, sandbox)
        files, destinations = {}, ()
    job = RenderJob(
        graph=str(graph),
        document=read_standard_input() if str(graph) == "-" else "",
        inputs=files,
        sets=settings,
        entries=entries,
        node=node,
        size=parsing.parse_size(size),
        scale=parsing.parse_scale(scale),
        frames=parsing.parse_frame_options(frame, frames) or (),
        precision=parsing.parse_precision(precision),
        form=parsing.parse_form(form),
        memory=parsing.parse_memory(memory),
        deterministic=deterministic,
        destinations=tuple((name, str(path)) for name, path in destinations),
        view=view,
        display=display,
        look=look,
        colorspace=colorspace,
        compression=compression,
        codec=codec,
        dither=parsing.parse_dither(dither),
        burn_in=burn_in,
        resume=resume,
        processes=parsing.parse_jobs(jobs),
        timeout=timeout,
        sandbox=sandbox,
    )
    if not cluster:
        return execute(job, parsing.parse_progress(progress), as_json)
    from ..cluster.path_map import parse_path_map
    from .execute_cluster import ClusterOptions, execute_on_cluster

    options = ClusterOptions(cluster, parse_path_map(path_map or ()), priority, detach)
    return execute_on_cluster(job, options, parsing.parse_progress(progress), as_json)


def _expand_each(
    each: Sequence[str],
    files: dict[str, str],
    settings: dict[str, str],
    destinations: Sequence[tuple[str, Path]],
    sandbox: Sandbox,
) -> "tuple[tuple[RenderEntry, ...], dict[str, str]]":
    """An entry for each file of --each, and the settings that all of them share: those that name no file."""
    from ..renderer.jobs.entry_list import expand_entries, names_file

    entries = expand_entries(each, files, settings, destinations, read_standard_input, sandbox)
    return entries, {name: text for name, text in settings.items() if not names_file(text)}


def _check_files(graph: Path, output: Sequence[str] | None, each: Sequence[str] | None) -> None:
    """Raise UsageError where files are missing, or two of them are standard input."""
    if not output and not each:
        raise UsageError("missing option '-o' / '--output'; see halation render --help")
    if each and str(graph) == "-" and "-" in each:
        raise UsageError("GRAPH and --each cannot both be read from standard input: name a file for one of them")


def _check_picture(deterministic: bool, form: str | None, burn_in: bool, node: str) -> None:
    """Raise UsageError for flags of the picture that exclude each other."""
    if deterministic and form == "compute":
        raise UsageError("--deterministic renders with fragment passes: leave out --form compute")
    if burn_in and node:
        raise UsageError("--burn-in writes over the outputs of the graph: leave out --node")

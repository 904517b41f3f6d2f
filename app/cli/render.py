"""`halation render`: a graph in, finished pictures out."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import UsageError
from . import parsing
from .options import (
    AsJson,
    Form,
    Frames,
    GraphFile,
    Inputs,
    LazyResourceProvider,
    Memory,
    Node,
    OneFrame,
    Precision,
    Scale,
    Sets,
    SizeText,
    bound,
    opened,
    report_problems,
)
from .outcome import note, print_json
from .progress import told_to
from .sharing import independent, piped, share
from .watchdog import PATIENCE, Timeout, watched

if TYPE_CHECKING:
    from ..renderer.jobs.job import Report


def render(
    context: typer.Context,
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
    timeout: Timeout = PATIENCE,
    as_json: AsJson = False,
) -> int:
    """Render a graph to files: one frame, or many.

    An output whose name holds a place for the frame number (shot.####.png, shot.%04d.png) asks for all frames of the
    graph unless some are named.
    """
    started = time.perf_counter()
    depth = parsing.precision(precision) if precision is not None else None
    passes = parsing.form(form) if form is not None else None
    if deterministic and passes == "compute":
        raise UsageError("--deterministic renders with fragment passes: leave out --form compute")
    told = parsing.progress(progress)
    destinations = parsing.paths(output)
    canvas, proxy, most = parsing.size(size), parsing.scale(scale), parsing.memory(memory)
    chosen = parsing.frames(frame, frames)
    opened_graph = opened(graph, sets or ())
    report_problems(graph, opened_graph)
    if (code := watched(context, opened_graph, timeout, piped(graph, opened_graph))) is not None:
        return code
    bindings, targets = bound(opened_graph, inputs or ()), parsing.targets(opened_graph, node)
    from ..renderer.opengl.warming import warm

    if not deterministic and jobs == 1:  # a pinned driver is loaded with other settings
        warm()
    from ..inputs.prefetch import Ahead

    alone = jobs == 1 and not resume and not targets and not most
    ahead = Ahead(opened_graph, bindings) if alone else None  # it reads while all else is loaded
    from ..renderer import DEFAULT_BUDGET, Renderer, RenderRequest, open_device, open_pinned
    from ..renderer.jobs.job import Writing, run_job

    if chosen is None:
        first, last = LazyResourceProvider().frames(opened_graph, inputs or ())
        chosen = tuple(range(first, last + 1)) if parsing.numbered(destinations) else (first,)
    videos = Writing(destinations).videos
    if codec and not videos:
        raise UsageError(f"--codec {codec}: that is for videos: write -o NAME.mp4, .mov, .mkv or .webm")
    if jobs > 1 and videos:
        note(f"one process renders all frames, since all are in {videos[0]}")
        jobs = 1
    if min(jobs, len(chosen)) > 1 and independent(opened_graph, targets, inputs or (), chosen[0]):
        # What came from standard input goes on with its values set.
        rest = sets if str(graph) != "-" else ()
        words = _words(graph, output, inputs, rest, node, size, scale, resume, precision, compression, form)
        words += _flags({"--memory": memory})
        words += _flags({"--view": view, "--display": display, "--look": look, "--colorspace": colorspace})
        words += ["--deterministic"] if deterministic else []
        with told_to(told, len(chosen)) as hears:
            reports = share(words, chosen, jobs, hears, piped(graph, opened_graph))
        return _told(_added(reports), time.perf_counter() - started, as_json)
    loaded = time.perf_counter()
    device = (open_pinned() if deterministic else open_device(passes)).within(most)
    # A job keeps what the next frame wants; where each frame is led up to, it wants more than that of the one before.
    led = len(chosen) > 1 and opened_graph.settings.preroll is not None
    renderer = Renderer(device, budget=DEFAULT_BUDGET if led and not most else 0, ahead=ahead)
    note(renderer.device.description)
    ready = time.perf_counter()
    wanted = RenderRequest(bindings, targets, canvas, proxy, precision="float" if deterministic else depth)
    writing = Writing(destinations, view, compression, depth or "half", display, look, colorspace, codec)
    with told_to(told, len(chosen)) as hears:
        report = run_job(renderer, opened_graph, wanted, writing, chosen, resume=resume, progress=hears)
    spent = {"load": loaded - started, "open": ready - loaded, **report.seconds}
    total = time.perf_counter() - started
    return _told(_as_json(report, renderer.device.description, {**spent, "total": total}), total, as_json)


def _as_json(report: Report, device: str, seconds: dict[str, float]) -> dict[str, Any]:
    return {
        "written": [str(path) for path in report.written],
        "frames": [item.frame for item in report.frames],
        "kept": [item.frame for item in report.frames if item.kept],
        "device": device,
        "passes": report.passes,
        "programs": report.programs,
        "peak_bytes": report.peak_bytes,
        "repaired": dict(report.repaired),
        "seconds": {name: round(part, 4) for name, part in seconds.items()},
    }


def _added(reports: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """What several processes did together. Each has textures of its own."""
    found = dict(reports[0])
    for other in reports[1:]:
        for name in ("written", "frames", "kept"):
            found[name] = [*found[name], *other[name]]
        for name in ("passes", "programs", "peak_bytes"):
            found[name] += other[name]
        found["repaired"] = {**found["repaired"], **other["repaired"]}
        found["seconds"] = {name: max(part, other["seconds"][name]) for name, part in found["seconds"].items()}
    order = sorted(range(len(found["frames"])), key=lambda place: found["frames"][place])
    each = len(found["written"]) // max(1, len(order))
    found["written"] = [path for place in order for path in found["written"][place * each : (place + 1) * each]]
    return {**found, "frames": sorted(found["frames"]), "kept": sorted(found["kept"])}


def _told(report: dict[str, Any], total: float, as_json: bool) -> int:
    from ..compiler.explain import size_text

    for path, count in report["repaired"].items():
        note(f"{path}: {count} pixels that are not numbers were filled from their neighbors")
    if as_json:
        print_json(report)
        return 0
    peak, passes, kept = size_text(report["peak_bytes"]), report["passes"], len(report["kept"])
    spent = f"{total:.2f} s, {passes} passes, {peak} of textures at the peak"
    if len(report["frames"]) > 1:
        files = list(dict.fromkeys((report["written"][0], report["written"][-1])))
        rest = f", {kept} kept as they were" if kept else ""
        note(f"{' ... '.join(files)}  {len(report['frames'])} frames{rest}, {spent}")
        return 0
    for path in report["written"]:
        note(f"{path}  kept as it was" if kept else f"{path}  {spent}")
    return 0


def _words(
    graph: Path,
    output: Sequence[str],
    inputs: Sequence[str] | None,
    sets: Sequence[str] | None,
    node: str,
    size: str | None,
    scale: float,
    resume: bool,
    precision: str | None,
    compression: str,
    form: str | None,
) -> list[str]:
    """The same call for another process."""
    listed = {"-o": output, "-i": inputs or (), "--set": sets or ()}
    single = {
        "--node": node,
        "--size": size,
        "--scale": repr(scale),
        "--precision": precision,
        "--compression": compression,
        "--form": form,
    }
    words = [str(graph), *(word for flag, items in listed.items() for item in items for word in (flag, item))]
    return [*words, *_flags(single), *(["--resume"] if resume else [])]


def _flags(texts: Mapping[str, str | None]) -> list[str]:
    return [f"{flag}={text}" for flag, text in texts.items() if text]

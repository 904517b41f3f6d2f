"""`halation bench`: where the time goes."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from . import parsing
from .batch import show_progress
from .options import (
    AsJson,
    Form,
    GraphFile,
    Inputs,
    Node,
    Scale,
    Sets,
    SizeText,
    open_graph,
    report_problems,
    resolve_inputs,
)
from .outcome import print_json
from .watchdog import Timeout, rerun_watched

if TYPE_CHECKING:
    from ..renderer.baseline import BaselineComparison, Ratio
    from ..renderer.bench import Benchmark, NodeShare

_BAR = 24


def bench(
    context: typer.Context,
    graph: GraphFile,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: Annotated[int | None, typer.Option(help="The frame to measure; by default the first of the graph.")] = None,
    frames: Annotated[str | None, typer.Option(metavar="1-24x8", help="Measure these frames together.")] = None,
    repeats: Annotated[int, typer.Option("-n", "--repeats", min=1, max=10_000, help="How often to measure.")] = 15,
    warm_up: Annotated[int, typer.Option("--warm-up", min=0, max=10_000, help="How often to render before that.")] = 3,
    passes: Annotated[bool, typer.Option("--passes", help="A line for every pass instead of every node.")] = False,
    compare: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Compare with what --json printed before.")
    ] = None,
    fail_over: Annotated[
        str | None, typer.Option(metavar="1.2", help="Exit with 1 if something takes more times as long as that.")
    ] = None,
    precision: Annotated[str | None, typer.Option(metavar="half|float", help="Precision of intermediates.")] = None,
    form: Form = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
) -> int:
    """Measure what each node and pass takes on this device: the median of several runs after warming up.

    Nodes that were fused into one pass have one time together.
    """
    from ..errors import UsageError
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer import Renderer, RenderRequest, open_device
    from ..renderer.baseline import compare_with_baseline
    from ..renderer.bench import measure_graph as measured

    limit = _limit(fail_over)
    if limit is not None and compare is None:
        raise UsageError("--fail-over: say what to compare with: --compare baseline.json")
    depth = parsing.precision(precision) if precision is not None else None
    way = parsing.form(form) if form is not None else None
    canvas, proxy, chosen = parsing.size(size), parsing.scale(scale), parsing.frames(frame, frames)
    whole = open_graph(graph, parsing.sets(sets))
    report_problems(graph, whole)
    if (code := rerun_watched(context, graph, whole, timeout)) is not None:
        return code
    bindings, targets = resolve_inputs(whole, parsing.inputs(inputs)), parsing.targets(whole, node)
    at = chosen or (LazyResourceProvider().find_frames(whole, bindings)[0],)
    renderer = Renderer(open_device(way), budget=0)
    request = RenderRequest(bindings, targets, canvas, proxy, precision=depth)
    with show_progress(renderer, len(at)) as work:
        timings = measured(renderer, whole, request, at, repeats, warm_up, work.step)
    if not timings.passes:
        raise UsageError(f"{graph}: there is nothing to measure: its outputs are made without a single pass")
    comparison = compare_with_baseline(timings, compare) if compare else None
    slower = comparison.slower(limit) if comparison and limit is not None else ()
    if as_json:
        print_json(_as_json(graph, timings, renderer.device.description, at, comparison, slower))
    else:
        _print(timings, passes, renderer.device.target.software, repeats)
        if comparison:
            _print_compared(comparison, slower, limit, renderer.device.description)
    return 1 if slower else 0


def _limit(text: str | None) -> float | None:
    """`1.2` or `1.2x`. Raises UsageError."""
    from ..errors import UsageError

    if text is None:
        return None
    try:
        ratio = float(text.removesuffix("x"))
    except ValueError:
        ratio = math.nan
    if not 0.0 < ratio < math.inf:
        raise UsageError(f"--fail-over {text}: write how many times as long is too long, such as 1.2")
    return ratio


def _print(timings: Benchmark, by_pass: bool, software: bool, repeats: int) -> None:
    from ..compiler.explain import format_bytes
    from ..renderer.bench import group_by_nodes

    if by_pass:
        rows = [
            (" + ".join(one.functions) + f"  [{', '.join(one.nodes)}]", one.median, one.read, one.written)
            for one in sorted(timings.passes, key=lambda one: -one.median)
        ]
    else:
        rows = [(_together(one), one.median, one.read, one.written) for one in group_by_nodes(timings.passes)]
    block, wide = _block(), min(60, max(len(row[0]) for row in rows))
    most = max(row[1] for row in rows)
    for label, seconds, read, written in rows:
        bar = block * max(1, round(_BAR * seconds / most))
        text = label if len(label) <= wide else f"{label[: wide - 3]}..."
        print(
            f"{text:<{wide}}  {seconds * 1e3:9.3f} ms  {seconds / timings.median:6.1%}  {bar:<{_BAR}}  "
            f"reads {format_bytes(read):>9}, writes {format_bytes(written):>9}"
        )
    how = "the clock around each pass" if software else "timer queries of the GPU"
    width, height = timings.size
    lead = f", {timings.lead} frames led up to it" if timings.lead else ""
    print(
        f"{'total':<{wide}}  {timings.median * 1e3:9.3f} ms  at {width}x{height}; median of {repeats} by {how}, "
        f"fastest {timings.fastest * 1e3:.3f} ms{lead}"
    )
    print(
        f"{'once':<{wide}}  plan {timings.planning * 1e3:.1f} ms, {timings.programs} programs "
        f"{timings.compiling * 1e3:.1f} ms, first run with files {timings.loading * 1e3:.1f} ms; "
        f"{format_bytes(timings.peak_bytes)} of textures at the peak"
    )


def _together(share: NodeShare) -> str:
    """The nodes of some passes, and how many these are."""
    return ", ".join(share.nodes) + (f"  {share.count} passes" if share.count > 1 else "")


def _print_compared(
    comparison: BaselineComparison, slower: tuple[Ratio, ...], limit: float | None, device: str
) -> None:
    if comparison.device != device:
        print(f"the baseline was measured on another device: {comparison.device}")
    if comparison.gone or comparison.new:
        print(f"{comparison.new} passes are new, {comparison.gone} are gone")
    for one in slower or sorted(comparison.ratios[1:], key=lambda one: -one.judged)[:5]:
        print(f"  {_ratio(one)}")
    whole = comparison.ratios[0]
    if not slower or whole not in slower:
        print(f"  {_ratio(whole)}")
    if limit is not None:
        verdict = f"{len(slower)} are slower than {limit:g}x" if slower else f"nothing is slower than {limit:g}x"
        print(f"{verdict}; judged by the smaller ratio of median and fastest time, passes from 2 % of the whole on")


def _ratio(ratio: Ratio) -> str:
    name = ", ".join(ratio.nodes) if ratio.nodes else "total"
    functions = f" ({' + '.join(ratio.functions)})" if ratio.functions else ""
    return (
        f"{ratio.judged:5.2f}x  {name}{functions}: {ratio.then * 1e3:.3f} -> {ratio.now * 1e3:.3f} ms "
        f"(median {ratio.median:.2f}x, fastest {ratio.fastest:.2f}x)"
    )


def _block() -> str:
    """What bars are made of, as far as the terminal can show it."""
    return "\N{FULL BLOCK}" if (sys.stdout.encoding or "").lower().startswith("utf") else "#"


def _as_json(
    graph: Path,
    timings: Benchmark,
    device: str,
    frames: tuple[int, ...],
    comparison: BaselineComparison | None,
    slower: tuple[Ratio, ...],
) -> dict[str, Any]:
    from ..renderer.bench import group_by_nodes, identify_passes

    report: dict[str, Any] = {
        "graph": str(graph),
        "device": device,
        "size": list(timings.size),
        "frames": list(frames),
        "repeats": len(timings.totals),
        "median": timings.median,
        "fastest": timings.fastest,
        "planning": timings.planning,
        "compiling": timings.compiling,
        "programs": timings.programs,
        "loading": timings.loading,
        "peak_bytes": timings.peak_bytes,
        "lead": timings.lead,
        "nodes": [
            {
                "nodes": list(one.nodes),
                "passes": one.count,
                "median": one.median,
                "fastest": one.fastest,
                "share": one.median / timings.median,
                "read_bytes": one.read,
                "written_bytes": one.written,
            }
            for one in group_by_nodes(timings.passes)
        ],
        "passes": [
            {
                "nodes": list(one.nodes),
                "functions": list(one.functions),
                "number": name[2],
                "median": one.median,
                "fastest": one.fastest,
                "read_bytes": one.read,
                "written_bytes": one.written,
            }
            for name, one in zip(identify_passes(timings.passes), timings.passes, strict=True)
        ],
    }
    if comparison:
        report["compared"] = {
            "device": comparison.device,
            "new": comparison.new,
            "gone": comparison.gone,
            "ratios": [_ratio_facts(one) for one in comparison.ratios],
            "slower": [_ratio_facts(one) for one in slower],
        }
    return report


def _ratio_facts(ratio: Ratio) -> dict[str, Any]:
    return {
        "nodes": list(ratio.nodes),
        "functions": list(ratio.functions),
        "median": ratio.median,
        "fastest": ratio.fastest,
        "ratio": ratio.judged,
    }

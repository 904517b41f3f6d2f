"""`halation bench`: measures how long each node and pass takes."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .batch import show_progress
from .options import (
    AsJson,
    Form,
    GraphFile,
    Inputs,
    Node,
    OneFrame,
    PassPrecision,
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
    from ..renderer.bench import Benchmark, NodeShare, PassTiming

_BAR = 24
"""Columns of a bar. Chosen by judgement: a line fits into 120 columns."""


_Frames = Annotated[str | None, typer.Option(metavar="1-24x8", help="Measure the sum over these frames.")]
_Repeats = Annotated[int, typer.Option("-n", "--repeats", min=1, max=10_000, help="Number of measured runs.")]
_WarmUp = Annotated[
    int, typer.Option("--warm-up", min=0, max=10_000, help="Number of runs before those that are measured.")
]
_Passes = Annotated[bool, typer.Option("--passes", help="Print a line per pass instead of per node.")]
_Compare = Annotated[Path | None, typer.Option(metavar="FILE", help="Compare with an earlier output of bench --json.")]
_FailOver = Annotated[
    str | None,
    typer.Option(
        metavar="1.2",
        help="Exit with 1 if a pass or the whole takes more than this many times as long as in --compare.",
    ),
]


def bench(
    context: typer.Context,
    graph: GraphFile,
    inputs: Inputs = None,
    sets: Sets = None,
    node: Node = "",
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: OneFrame = None,
    frames: _Frames = None,
    repeats: _Repeats = 15,
    warm_up: _WarmUp = 3,
    passes: _Passes = False,
    compare: _Compare = None,
    fail_over: _FailOver = None,
    precision: PassPrecision = None,
    form: Form = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Measure how long each node takes.

    Prints the median of several runs on this device, after warm-up runs. Nodes that are fused into one pass are
    measured together.
    """
    from ..errors import UsageError
    from ..inputs.lazy_provider import LazyResourceProvider
    from ..renderer import Renderer, RenderRequest, open_device
    from ..renderer.baseline import compare_with_baseline
    from ..renderer.bench import measure_graph

    highest_ratio = _parse_ratio(fail_over)
    if highest_ratio is not None and compare is None:
        raise UsageError("--fail-over: name the file to compare with: --compare baseline.json")
    parsed_precision = parsing.parse_precision(precision)
    pass_form = parsing.parse_form(form)
    canvas = parsing.parse_size(size)
    proxy = parsing.parse_scale(scale)
    named_frames = parsing.parse_frame_options(frame, frames)
    opened_graph = open_graph(graph, parsing.parse_sets(sets), sandbox=sandbox)
    report_problems(graph, opened_graph)
    if (code := rerun_watched(context, graph, opened_graph, timeout)) is not None:
        return code
    bindings = resolve_inputs(opened_graph, parsing.parse_inputs(inputs))
    targets = parsing.find_targets(opened_graph, node)
    measured_frames = named_frames or (LazyResourceProvider(sandbox).find_frames(opened_graph, bindings)[0],)
    renderer = Renderer(open_device(pass_form, sandbox=sandbox), budget=0, sandbox=sandbox)
    request = RenderRequest(bindings, targets, canvas, proxy, precision=parsed_precision)
    with show_progress(renderer, len(measured_frames)) as batch:
        benchmark = measure_graph(renderer, opened_graph, request, measured_frames, repeats, warm_up, batch.step)
    if not benchmark.passes:
        raise UsageError(f"{graph}: there is nothing to measure: the graph needs no pass")
    comparison = compare_with_baseline(benchmark, compare, sandbox) if compare else None
    slower = comparison.find_slower(highest_ratio) if comparison and highest_ratio is not None else ()
    device = renderer.device
    if as_json:
        print_json(_benchmark_facts(graph, benchmark, device.description, measured_frames, comparison, slower))
    else:
        _print_benchmark(benchmark, passes, device.target.software, repeats)
        if comparison:
            _print_comparison(comparison, slower, highest_ratio, device.description)
    return 1 if slower else 0


def _parse_ratio(text: str | None) -> float | None:
    """The ratio from `1.2` or `1.2x`; None without a text. Raises UsageError."""
    from ..errors import UsageError

    if text is None:
        return None
    try:
        ratio = float(text.removesuffix("x"))
    except ValueError:
        ratio = math.nan
    if not 0.0 < ratio < math.inf:
        raise UsageError(f"--fail-over {text}: write a ratio above 0, such as 1.2 for 20 % slower")
    return ratio


def _print_benchmark(benchmark: Benchmark, by_pass: bool, software: bool, repeats: int) -> None:
    from ..compiler.explain import format_bytes
    from ..renderer.bench import group_by_nodes

    if by_pass:
        rows = [
            (
                " + ".join(share.functions) + f"  [{', '.join(share.nodes)}]",
                share.median,
                share.bytes_read,
                share.bytes_written,
            )
            for share in sorted(benchmark.passes, key=lambda share: -share.median)
        ]
    else:
        rows = [
            (_describe_share(share), share.median, share.bytes_read, share.bytes_written)
            for share in group_by_nodes(benchmark.passes)
        ]
    bar_letter, label_width = _bar_letter(), min(60, max(len(row[0]) for row in rows))
    longest = max(row[1] for row in rows)
    for label, seconds, read, written in rows:
        bar = bar_letter * max(1, round(_BAR * seconds / longest))
        short_label = label if len(label) <= label_width else f"{label[: label_width - 3]}..."
        print(
            f"{short_label:<{label_width}}  {seconds * 1e3:9.3f} ms  {seconds / benchmark.median:6.1%}  {bar:<{_BAR}}  "
            f"reads {format_bytes(read):>9}, writes {format_bytes(written):>9}"
        )
    method = "the clock around each pass" if software else "timer queries of the GPU"
    width, height = benchmark.size
    lead_note = f", {benchmark.lead_frames} frames led up to it" if benchmark.lead_frames else ""
    print(
        f"{'total':<{label_width}}  {benchmark.median * 1e3:9.3f} ms  at {width}x{height}; "
        f"median of {repeats} by {method}, fastest {benchmark.fastest * 1e3:.3f} ms{lead_note}"
    )
    print(
        f"{'once':<{label_width}}  plan {benchmark.planning * 1e3:.1f} ms, {benchmark.programs} programs "
        f"{benchmark.compiling * 1e3:.1f} ms, first run with files {benchmark.loading * 1e3:.1f} ms; "
        f"{format_bytes(benchmark.peak_bytes)} of textures at the peak"
    )


def _describe_share(share: NodeShare) -> str:
    """The nodes of one share, and the number of their passes if there are several."""
    return ", ".join(share.nodes) + (f"  {share.count} passes" if share.count > 1 else "")


def _print_comparison(
    comparison: BaselineComparison, slower: tuple[Ratio, ...], highest_ratio: float | None, device: str
) -> None:
    if comparison.device != device:
        print(f"the baseline was measured on another device: {comparison.device}")
    if comparison.missing_passes or comparison.new_passes:
        print(f"{comparison.new_passes} passes are new, {comparison.missing_passes} are gone")
    for ratio in slower or sorted(comparison.ratios[1:], key=lambda ratio: -ratio.smaller)[:5]:
        print(f"  {_describe_ratio(ratio)}")
    total_ratio = comparison.ratios[0]
    if not slower or total_ratio not in slower:
        print(f"  {_describe_ratio(total_ratio)}")
    if highest_ratio is not None:
        verdict = (
            f"{len(slower)} are slower than {highest_ratio:g}x"
            if slower
            else f"nothing is slower than {highest_ratio:g}x"
        )
        print(f"{verdict}; judged by the smaller ratio of median and fastest time, passes from 2 % of the whole on")


def _describe_ratio(ratio: Ratio) -> str:
    name = ", ".join(ratio.nodes) if ratio.nodes else "total"
    functions = f" ({' + '.join(ratio.functions)})" if ratio.functions else ""
    return (
        f"{ratio.smaller:5.2f}x  {name}{functions}: {ratio.before * 1e3:.3f} -> {ratio.current * 1e3:.3f} ms "
        f"(median {ratio.median:.2f}x, fastest {ratio.fastest:.2f}x)"
    )


def _bar_letter() -> str:
    """The character of bars: a block if the terminal can show it, else #."""
    return "\N{FULL BLOCK}" if (sys.stdout.encoding or "").lower().startswith("utf") else "#"


def _benchmark_facts(
    graph: Path,
    benchmark: Benchmark,
    device: str,
    frames: tuple[int, ...],
    comparison: BaselineComparison | None,
    slower: tuple[Ratio, ...],
) -> dict[str, Any]:
    from ..renderer.bench import group_by_nodes, identify_passes

    report: dict[str, Any] = {
        "graph": str(graph),
        "device": device,
        "size": list(benchmark.size),
        "frames": list(frames),
        "repeats": len(benchmark.totals),
        "median": benchmark.median,
        "fastest": benchmark.fastest,
        "planning": benchmark.planning,
        "compiling": benchmark.compiling,
        "programs": benchmark.programs,
        "loading": benchmark.loading,
        "peak_bytes": benchmark.peak_bytes,
        "lead": benchmark.lead_frames,
        "nodes": [_share_facts(share, benchmark.median) for share in group_by_nodes(benchmark.passes)],
        "passes": [
            _pass_facts(timing, name[2])
            for name, timing in zip(identify_passes(benchmark.passes), benchmark.passes, strict=True)
        ],
    }
    if comparison:
        report["compared"] = {
            "device": comparison.device,
            "new": comparison.new_passes,
            "gone": comparison.missing_passes,
            "ratios": [_ratio_facts(ratio) for ratio in comparison.ratios],
            "slower": [_ratio_facts(ratio) for ratio in slower],
        }
    return report


def _share_facts(share: NodeShare, whole: float) -> dict[str, Any]:
    return {
        "nodes": list(share.nodes),
        "passes": share.count,
        "median": share.median,
        "fastest": share.fastest,
        "share": share.median / whole,
        "read_bytes": share.bytes_read,
        "written_bytes": share.bytes_written,
    }


def _pass_facts(timing: PassTiming, number: int) -> dict[str, Any]:
    return {
        "nodes": list(timing.nodes),
        "functions": list(timing.functions),
        "number": number,
        "median": timing.median,
        "fastest": timing.fastest,
        "read_bytes": timing.bytes_read,
        "written_bytes": timing.bytes_written,
    }


def _ratio_facts(ratio: Ratio) -> dict[str, Any]:
    return {
        "nodes": list(ratio.nodes),
        "functions": list(ratio.functions),
        "median": ratio.median,
        "fastest": ratio.fastest,
        "ratio": ratio.smaller,
    }

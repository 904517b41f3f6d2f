"""All that was measured, as a table. Standard library alone: see `tasks`."""

from __future__ import annotations

from bench.figures import format_number
from bench.programs import OURS
from bench.results import Results, Run, median_ratio
from bench.tasks import TASKS


def format_results(results: Results, earlier: Results | None = None) -> str:
    """A line for each size, task and program, the fastest first. With earlier results, how ours have changed."""
    names = ["size", "task", "program", "wall s", "fastest", "cpu s", "MiB", "op ms", "rms", "peak"]
    names += ["wall, op against before"] if earlier else []
    lines = [f"| {' | '.join(names)} |", "|" + "---|" * len(names)]
    order = {name: number for number, name in enumerate(TASKS)}
    sizes = list(dict.fromkeys(run.size for run in results.runs))

    def sort_key(one: Run) -> tuple[int, int, float]:
        first = results.middle(one.size, one.task, one.program, "wall" if one.wall else "op")
        return sizes.index(one.size), order[one.task], first if first is not None else float("inf")

    for one in sorted(results.runs, key=sort_key):
        cells = [one.size, one.task, f"**{one.program}**" if one.program == OURS else one.program]
        cells += [f"{one.error} |" + " |" * 5] if one.error else _format_numbers(results, one)
        if earlier:
            cells.append(_format_change(one, earlier.find(one.size, one.task, one.program)))
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _format_numbers(results: Results, run: Run) -> list[str]:
    medians = {what: results.middle(run.size, run.task, run.program, what) for what in ("wall", "cpu", "memory", "op")}
    return [
        _format_number(medians["wall"], ".2f"),
        _format_number(min(run.wall, default=None), ".2f"),
        _format_number(medians["cpu"], ".2f"),
        _format_number(medians["memory"], ".0f"),
        _format_number(medians["op"], ".1f", 1e3),
        format_number(run.rms) if run.rms is not None else "",
        format_number(run.peak) if run.peak is not None else "",
    ]


def _format_number(number: float | None, form: str, factor: float = 1.0) -> str:
    return "" if number is None else f"{number * factor:{form}}"


def _format_change(run: Run, before: Run | None) -> str:
    if before is None:
        return ""
    changes = (median_ratio(run.wall, before.wall), median_ratio(run.op, before.op))
    return ", ".join("\N{EN DASH}" if change is None else f"{change:.2f}" for change in changes)

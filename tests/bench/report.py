"""All that was measured, as a table. Standard library alone: see `tasks`."""

from __future__ import annotations

from bench.figures import number_text
from bench.programs import OURS
from bench.results import Results, Run, paired
from bench.tasks import TASKS


def listing(results: Results, earlier: Results | None = None) -> str:
    """A line for each size, task and program, the fastest first. With earlier results, how ours have changed."""
    names = ["size", "task", "program", "wall s", "fastest", "cpu s", "MiB", "op ms", "rms", "peak"]
    names += ["wall, op against before"] if earlier else []
    lines = [f"| {' | '.join(names)} |", "|" + "---|" * len(names)]
    order = {name: number for number, name in enumerate(TASKS)}
    sizes = list(dict.fromkeys(one.size for one in results.runs))

    def place(one: Run) -> tuple[int, int, float]:
        first = results.middle(one.size, one.task, one.program, "wall" if one.wall else "op")
        return sizes.index(one.size), order[one.task], first if first is not None else float("inf")

    for one in sorted(results.runs, key=place):
        cells = [one.size, one.task, f"**{one.program}**" if one.program == OURS else one.program]
        cells += [f"{one.error} |" + " |" * 5] if one.error else _numbers(results, one)
        if earlier:
            cells.append(_change(one, earlier.find(one.size, one.task, one.program)))
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _numbers(results: Results, one: Run) -> list[str]:
    middle = {what: results.middle(one.size, one.task, one.program, what) for what in ("wall", "cpu", "memory", "op")}
    return [
        _text(middle["wall"], ".2f"),
        _text(min(one.wall, default=None), ".2f"),
        _text(middle["cpu"], ".2f"),
        _text(middle["memory"], ".0f"),
        _text(middle["op"], ".1f", 1e3),
        number_text(one.rms) if one.rms is not None else "",
        number_text(one.peak) if one.peak is not None else "",
    ]


def _text(number: float | None, form: str, factor: float = 1.0) -> str:
    return "" if number is None else f"{number * factor:{form}}"


def _change(one: Run, before: Run | None) -> str:
    if before is None:
        return ""
    changes = (paired(one.wall, before.wall), paired(one.op, before.op))
    return ", ".join("\N{EN DASH}" if change is None else f"{change:.2f}" for change in changes)

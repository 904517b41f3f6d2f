"""What was measured on a card, in Markdown, and whether it is what is wanted. Standard library alone: see `tasks`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from statistics import median

from bench.figures import Figure, Row, format_number
from bench.results import Results, Run, median_ratio
from halation.compiler import Form, Precision

COPY = 0.7
"""How much of the bandwidth of a copy fused nodes are to reach."""
FLOORS = 3.0
STACK = 4e-3
ROUNDING = 2.0
"""Two pictures that are both rounded may be so many times as far apart as one that is rounded from one that is not."""
UNSEEN = 1e-3
"""FLIP that nobody can see: rounding may change less than that, and then this is the limit."""
FORMS: tuple[Form, ...] = ("compute", "fragment")
PRECISIONS: tuple[Precision, ...] = ("half", "float")

_NOTHING = (
    "**{card} is a software rasterizer: these figures mean nothing. They show that all of it runs.**",
    "**A dry run, of pictures far too small: these figures mean nothing.**",
)


def format_heading(results: Results) -> list[str]:
    """The card, its driver, and what the figures are worth."""
    machine = results.machine
    lines = [f"{machine['card']}, {machine['driver']}; {machine['form']} passes ({machine['why']})"]
    if machine.get("nvidia"):
        lines.append(f"nvidia-smi: {machine['nvidia']}")
    if machine["software"] or machine["dry"]:
        lines.append(_NOTHING[0 if machine["software"] else 1].format(**machine))
    ratio = results.extras.get("queries")
    if ratio is not None:
        how = "timer queries" if not machine["software"] else "the clock, since queries of a software rasterizer lie"
        lines.append(f"Measured by {how}. Of many copies a query says {ratio:.2f} of what the clock says.")
    return lines


def bandwidth(results: Results) -> float | None:
    """The fastest copy, in bytes per second."""
    return max((copy["bandwidth"] for copy in results.extras.get("copies", {}).values()), default=None)


def format_results(results: Results) -> str:
    """All of it."""
    lines = [*format_heading(results), ""]
    if copies := results.extras.get("copies"):
        lines += ["| copy | MiB | ms | GB/s | arrived |", "|---|---|---|---|---|"]
        lines += [
            f"| {way} | {one['nbytes'] / 2**20:.0f} | {median(one['seconds']) * 1e3:.3f} | "
            f"{one['bandwidth'] / 1e9:.0f} | {'yes' if one['same'] else '**no**'} |"
            for way, one in copies.items()
        ]
        lines.append("")
    if results.runs:
        names = (
            "what",
            "size",
            "passes are",
            "number",
            "ms",
            "fastest",
            "frame by the clock ms",
            "MiB moved",
            "GB/s",
            "of a copy",
            "floor ms",
            "times the floor",
        )
        lines += [f"| {' | '.join(names)} |", "|" + "---|" * len(names)]
        lines += [f"| {' | '.join(_cells(results, one))} |" for one in results.runs]
        lines.append("")
    if presets := results.extras.get("presets"):
        names = ("preset", "half against software", "float against software", "what rounding to half does")
        lines += [f"| {' | '.join(names)} |", "|---|---|---|---|"]
        lines += [f"| {name} | {' | '.join(_flips(one))} |" for name, one in presets.items()]
        lines.append("")
    return "\n".join(lines)


def _flips(one: Mapping[str, float]) -> list[str]:
    return [format_number(one[name]) for name in ("half", "float", "rounding")]


def _cells(results: Results, one: Run) -> list[str]:
    first = [one.task, one.size, one.program]
    if one.error:
        return [*first, one.error, *[""] * 8]
    known, seconds, speed = results.extras["bytes"][one.task][one.program], median(one.op), bandwidth(results)
    moved, share, least, times = known["moved"] / seconds, "", "", ""
    if speed:
        share, least = f"{moved / speed:.0%}", f"{known['floor'] / speed * 1e3:.3f}"
        times = f"{seconds * speed / known['floor']:.2f}"
    return [
        *first,
        str(known["passes"]),
        f"{seconds * 1e3:.3f}",
        f"{min(one.op) * 1e3:.3f}",
        f"{median(one.wall) * 1e3:.3f}",
        f"{known['moved'] / 2**20:.1f}",
        f"{moved / 1e9:.0f}",
        share,
        least,
        times,
    ]


def compute_rows(results: Results) -> Iterator[Row]:
    """What is wanted, of the form of passes that the device is given, with intermediates of half floats."""
    own = f"{results.machine['form']} half"

    def floors(task: str, limit: float) -> Figure:
        one, speed = _find_run(results, task, own), bandwidth(results)
        if one is None or not speed:
            return Figure(task, None, limit)
        return Figure(task, median(one.op) * speed / results.extras["bytes"][task][own]["floor"], limit)

    yield Row(
        "ten fused nodes at 7680x4320, in times of copying input to output",
        f"{1 / COPY:.2f}: {COPY:.0%} of the bandwidth",
        (floors("chain", 1.0 / COPY),),
    )
    yield Row(
        "Gaussian blur and bloom at 3840x2160, in times of reading the input once and writing the output once",
        f"{FLOORS:g}",
        tuple(floors(task, FLOORS) for task in ("T1s3", "T1s10", "T1s50", "bloom")),
    )
    stack = _find_run(results, "stack", own)
    yield Row(
        "the preset post_stack at 3840x2160, all passes",
        f"{STACK * 1e3:g} ms",
        (Figure("", median(stack.op) * 1e3 if stack else None, STACK * 1e3, " ms"),),
    )
    forms, precisions = [f"{form} half" for form in FORMS], [f"{results.machine['form']} {one}" for one in PRECISIONS]
    yield Row("compute against fragment passes", "to be known", tuple(_compute_ratios(results, *forms)))
    yield Row("half against float intermediates", "to be known", tuple(_compute_ratios(results, *precisions)))
    presets = results.extras.get("presets", {})
    yield Row(
        "presets against the software rasterizer: mean of FLIP, half",
        f"{ROUNDING:g} times what rounding does, or {UNSEEN:g}",
        tuple(Figure(name, one["half"], max(ROUNDING * one["rounding"], UNSEEN)) for name, one in presets.items()),
    )


def _find_run(results: Results, task: str, program: str) -> Run | None:
    run = next((one for one in results.runs if (one.task, one.program) == (task, program)), None)
    return run if run and run.op else None


def _compute_ratios(results: Results, program: str, another: str) -> Iterator[Figure]:
    for task in dict.fromkeys(one.task for one in results.runs):
        one, other = _find_run(results, task, program), _find_run(results, task, another)
        if one and other:
            yield Figure(task, median_ratio(one.op, other.op), float("inf"))


def format_table(results: Results) -> str:
    """What is wanted, and what came of it. Where the figures mean nothing no verdict is given."""
    worth = not (results.machine["software"] or results.machine["dry"])
    lines = ["| what | wanted, at most | measured | reached |", "|---|---|---|---|"]
    for row in compute_rows(results):
        known = ", ".join(
            str(one) if worth else f"{one.label} {format_number(one.number)}{one.unit}".strip()
            for one in row.figures
            if one.number is not None
        )
        lines.append(f"| {row.what} | {row.wanted} | {known or 'not measured'} | {row.verdict if worth else 'dry'} |")
    return "\n".join(lines)

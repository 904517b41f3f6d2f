"""`halation diff`: what changed between two graphs, by node and value."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.render_choices import DEFAULT_TIMEOUT
from ..resources.sandbox import Sandbox
from . import parsing
from .options import AsJson, Inputs, Scale, SizeText
from .outcome import print_json
from .versions import is_colored, load_version, paint, print_lines
from .watchdog import Timeout, run_watched

if TYPE_CHECKING:
    from ..document.diff_merge import DifferenceLine, GraphDifference, PartChange

TROUBLE = 2
"""The exit code of errors that have 1 elsewhere, because 1 means here that the graphs differ."""

_VERSION = "The old graph: a JSON file, REV:FILE in git, or - for standard input."


_A = Annotated[str, typer.Argument(metavar="A", help=_VERSION)]
_B = Annotated[str, typer.Argument(metavar="B", help="The new graph, named in the same ways.")]
_Layout = Annotated[bool, typer.Option("--layout", help="Also list what moved on the canvas.")]
_Render = Annotated[bool, typer.Option("--render", help="Also render both graphs and compare the pictures.")]
_Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="FILE.png", help="Write the pictures side by side, with their differences."),
]
_Frame = Annotated[int | None, typer.Option(help="Render this frame; by default the first frame of A.")]


def diff(
    a: _A,
    b: _B,
    layout: _Layout = False,
    render: _Render = False,
    output: _Output = None,
    inputs: Inputs = None,
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: _Frame = None,
    timeout: Timeout = DEFAULT_TIMEOUT,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Show what changed between two graphs.

    Exits with 0 if nothing changed, else with 1. Compares nodes, values, links, animation, inputs, outputs, settings
    and code, also inside groups. The formatting of the files makes no difference.
    """
    from ..document.diff_merge import compare_graphs, describe_difference
    from ..errors import RenderError, UsageError

    if not render and (output or inputs or size or frame is not None or scale != 1.0):
        raise UsageError("-o, -i, --size, --scale and --frame need --render")
    _check_files(a, b, output, render)
    before, after = load_version(a, sandbox=sandbox), load_version(b, sandbox=sandbox)
    changes = compare_graphs(before, after, layout=layout)
    lines = describe_difference(changes, before, after)
    report: dict[str, Any] = {"a": a, "b": b, "same": not changes, **difference_facts(changes, lines)}
    if not as_json:
        print_lines(lines, is_colored())
    if not render:
        return _finish_report(report, as_json)
    choices = (parsing.parse_inputs(inputs), parsing.parse_size(size), parsing.parse_scale(scale), frame)

    def work() -> int:
        from .picture_diff import render_and_compare

        try:
            report["pictures"] = render_and_compare(a, b, choices, output, sandbox)
        except RenderError as fault:
            fault.exit_code = TROUBLE
            raise
        report["same"] = not changes and all(picture["same"] for picture in report["pictures"])
        for picture in report["pictures"] if not as_json else ():
            sign = "=" if picture["same"] else "~"
            print(paint(f"{sign} picture {picture['output']}: {picture['words']}", sign, is_colored()))
        return _finish_report(report, as_json)

    return run_watched(work, (before, after), timeout, as_json)


def _finish_report(report: dict[str, Any], as_json: bool) -> int:
    """Print the report as JSON if that is asked for; the exit code."""
    if as_json:
        print_json(report)
    return 0 if report["same"] else 1


def _check_files(a: str, b: str, output: Path | None, render: bool) -> None:
    """Raise UsageError for files that cannot be compared or written."""
    from ..errors import UsageError

    if a == b == "-":
        raise UsageError("- can be used only once: name a file as A or B")
    if output and output.suffix.lower() != ".png":
        raise UsageError(f"-o {output}: pictures side by side are written as .png")
    if render and "-" in (a, b):
        raise UsageError("--render reads both graphs twice: name files instead of -")


def difference_facts(changes: GraphDifference, lines: tuple[DifferenceLine, ...]) -> dict[str, Any]:
    """A difference as JSON: every change with its place, and the lines that `diff` prints."""
    return {
        "renamed": [
            {"group": list(renaming.group), "old": renaming.old, "new": renaming.new} for renaming in changes.renamed
        ],
        "changes": [_change_facts(change) for change in changes.changes],
        "lines": [f"{line.sign} {line.words}" for line in lines],
    }


def _change_facts(change: PartChange) -> dict[str, Any]:
    """A change as JSON; a side where the part is absent has no key."""
    from ..document.diff_merge import ABSENT, to_document

    sides = {"before": to_document(change.before), "after": to_document(change.after)}
    return {"at": list(change.at), **{side: part for side, part in sides.items() if part is not ABSENT}}

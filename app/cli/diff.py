"""`halation diff`: what changed between two graphs, in the words of graphs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from . import parsing
from .options import AsJson, Inputs, Scale, SizeText
from .outcome import print_json
from .versions import is_colored, load_version, paint, print_lines

if TYPE_CHECKING:
    from ..document.diff_merge import DifferenceLine, GraphDifference, PartChange

TROUBLE = 2
"""What `diff` makes of exit code 1, which says that there is a difference."""

_VERSION = "A graph, as JSON: a file, REV:FILE in git, or - for standard input."


def diff(
    a: Annotated[str, typer.Argument(metavar="A", help=_VERSION)],
    b: Annotated[str, typer.Argument(metavar="B", help="The same for what it is compared with.")],
    layout: Annotated[bool, typer.Option("--layout", help="Tell what moved on the canvas too.")] = False,
    render: Annotated[bool, typer.Option("--render", help="Render both, and compare the pictures too.")] = False,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE.png", help="The pictures side by side, and where.")
    ] = None,
    inputs: Inputs = None,
    size: SizeText = None,
    scale: Scale = 1.0,
    frame: Annotated[int | None, typer.Option(help="The frame to render; by default the first of A.")] = None,
    as_json: AsJson = False,
) -> int:
    """Tell what changed between two graphs: 0 if nothing did, 1 if something did.

    Nodes, values, links, keys, ends, settings, code; groups are looked into. How a file is written makes no difference.
    """
    from ..document.diff_merge import compare_graphs, describe_difference
    from ..errors import RenderError, UsageError

    if a == b == "-":
        raise UsageError("- is there once: name a file as A or B")
    if not render and (output or inputs or size or frame is not None or scale != 1.0):
        raise UsageError("-o, -i, --size, --scale and --frame are for pictures: add --render")
    if output and output.suffix.lower() != ".png":
        raise UsageError(f"-o {output}: the pictures side by side are a .png")
    if render and "-" in (a, b):
        raise UsageError("--render reads both graphs twice: name files instead of -")
    before, after = load_version(a), load_version(b)
    changes = compare_graphs(before, after, layout=layout)
    lines = describe_difference(changes, before, after)
    report: dict[str, Any] = {"a": a, "b": b, "same": not changes, **as_tree(changes, lines)}
    if not as_json:
        print_lines(lines, is_colored())
    if render:
        from .picture_diff import render_and_compare

        choices = (parsing.inputs(inputs), parsing.size(size), parsing.scale(scale), frame)
        try:
            report["pictures"] = render_and_compare(a, b, choices, output)
        except RenderError as fault:
            fault.exit_code = TROUBLE
            raise
        report["same"] = not changes and all(one["same"] for one in report["pictures"])
        for one in report["pictures"] if not as_json else ():
            sign = "=" if one["same"] else "~"
            print(paint(f"{sign} picture {one['output']}: {one['words']}", sign, is_colored()))
    if as_json:
        print_json(report)
    return 0 if report["same"] else 1


def as_tree(changes: GraphDifference, lines: tuple[DifferenceLine, ...]) -> dict[str, Any]:
    """A difference for machines: every change with its place, and the same lines that people read."""
    return {
        "renamed": [{"group": list(one.group), "old": one.old, "new": one.new} for one in changes.renamed],
        "changes": [_change(change) for change in changes.changes],
        "lines": [f"{line.sign} {line.words}" for line in lines],
    }


def _change(change: PartChange) -> dict[str, Any]:
    """What is absent has no key."""
    from ..document.diff_merge import ABSENT, to_document

    sides = {"before": to_document(change.before), "after": to_document(change.after)}
    return {"at": list(change.at), **{side: part for side, part in sides.items() if part is not ABSENT}}

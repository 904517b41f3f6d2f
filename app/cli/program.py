"""The program: commands, what they share, and how they end."""

from __future__ import annotations

import sys
from collections.abc import Sequence

import typer
from typer.main import get_command

from .bench import bench
from .check import check
from .demo import demo
from .diff import diff
from .edit import edit
from .explain import explain
from .export_isf import export_isf
from .fmt import fmt
from .gallery import gallery
from .git_driver import git_driver
from .git_setup import git_setup
from .info import info
from .merge import merge
from .nodes import nodes
from .options import rooted
from .outcome import EXIT_CODES, failed, guarded, settle
from .render import render
from .reproduce import reproduce
from .schema import schema
from .sweep import sweep
from .test import test
from .watch import watch

app = typer.Typer(
    name="halation", add_completion=False, rich_markup_mode=None, epilog=EXIT_CODES,
    help="A node-graph compositor for screen-space effects.",
)
fenced = (render, check, explain, export_isf, info, diff, test, reproduce, watch, sweep, bench)
"""Commands that take graphs and pictures from people who may not be trusted."""
for command in (
    edit, render, check, explain, info, nodes, fmt, diff, merge, git_setup, demo, gallery, test, schema,
    reproduce, watch, sweep, bench, export_isf,
):
    app.command()(guarded(rooted(command) if command in fenced else command))
app.command(hidden=True)(guarded(git_driver))


@app.callback(invoke_without_command=True)
def whole(
    context: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and stop."),
) -> None:
    """What there is to say without a command."""
    if version:
        from importlib import metadata

        print(f"halation {metadata.version('halation')}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(context.get_help(), file=sys.stderr)
        raise typer.Exit(2)


def run(arguments: Sequence[str]) -> int:
    """Run one command and return its exit code. Nothing is raised."""
    as_json = "--json" in arguments
    try:
        words = tuple(arguments)
        code = get_command(app).main(list(words), prog_name="halation", standalone_mode=False, obj=words)
    except (Exception, KeyboardInterrupt) as fault:
        code = failed(fault, as_json)
    return settle(code if isinstance(code, int) else 0)

"""The commands. Each imports what it needs when it runs, so that `--help` is instant and no command opens a window."""

from __future__ import annotations

import os
import sys

import typer

from .check import check
from .demo import demo
from .explain import explain
from .fmt import fmt
from .nodes import nodes
from .outcome import EXIT_CODES
from .render import render

app = typer.Typer(
    name="halation", no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False,
    rich_markup_mode=None, help="A node-graph compositor for screen-space effects.", epilog=EXIT_CODES,
)
for command in (render, check, explain, nodes, fmt, demo):
    app.command()(command)


@app.callback(invoke_without_command=True)
def _global(
    version: bool = typer.Option(False, "--version", help="Print the version and stop."),
) -> None:
    if version:
        from importlib import metadata

        print(f"halation {metadata.version('halation')}")
        raise typer.Exit


def main() -> None:
    """Run the command line, and leave at once: nothing is left to tidy up that the system does not take back."""
    code = 0
    try:
        app()
    except SystemExit as left:
        code = left.code if isinstance(left.code, int) else 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)

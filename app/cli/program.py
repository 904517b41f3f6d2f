"""The program `halation`: its list of commands, and how each is run."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import CodeType, MappingProxyType
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from ..errors import RenderError
from ..resources.machine import has_memory_limit, memory_limit
from ..version import VERSION
from .outcome import EXIT_CODES, catch_faults, flush_output, report_failure
from .parsing import check_words

_VISIBLE = (
    "edit",
    "render",
    "submit",
    "jobs",
    "serve",
    "check",
    "explain",
    "info",
    "nodes",
    "fmt",
    "diff",
    "merge",
    "git-setup",
    "demo",
    "gallery",
    "test",
    "schema",
    "reproduce",
    "watch",
    "sweep",
    "fit",
    "bench",
    "export",
    "doctor",
    "cache",
    "desktop",
)
_HIDDEN = ("export-isf", "git-driver", "thumbnail", "worker")
_LEAST_MEMORY = 288 << 20
"""Bytes of address space. Libraries of pictures and colors end the process, or wait for ever, where they cannot be
loaded and started in it: measured on Linux with four cores."""

WITHOUT_ROOT = MappingProxyType(
    {
        "edit": "the user of the editor chooses its files",
        "demo": "it reads no files but those of Halation",
        "gallery": "it reads no files but those of Halation",
        "schema": "it reads no file",
        "jobs": "it reads no file",
        "doctor": "it reads no files but those that every command reads",
        "cache": "it reads no files but those of the driver, and an archive",
        "desktop": "it reads no files but those of Halation",
        "thumbnail": "it reads only from the folder of its file",
        "git-setup": "it reads no graph but those of the repository, and writes the configuration of git",
        "git-driver": "git hands it files of the repository, and copies in temporary folders",
        "worker": "the render job names the root",
    }
)
"""Commands without `--root`, and why. All others have it, because their files may come from strangers."""


class Commands(Mapping[str, Any]):
    """The click commands by name: each is the function of its name in the module of its name.

    A module is imported only when its command runs, so that the program starts fast.
    """

    def __getitem__(self, name: str) -> Any:
        if name not in (*_VISIBLE, *_HIDDEN):
            raise KeyError(name)
        return _command(name)

    def __iter__(self) -> Iterator[str]:
        return iter((*_VISIBLE, *_HIDDEN))

    def __len__(self) -> int:
        return len(_VISIBLE) + len(_HIDDEN)


class _Group(TyperGroup):
    """A group that imports a command only when it runs."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**{**options, "commands": Commands()})

    def list_commands(self, ctx: Any) -> list[str]:
        """The names of the commands, in the order of the help."""
        return list(self.commands)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of the commands, each with the start of its docstring."""
        limit = formatter.width - 6 - max(map(len, _VISIBLE))  # as the method that this one replaces
        with formatter.section("Commands"):
            formatter.write_dl(
                [(name, TyperCommand(name, help=read_summary(name)).get_short_help_str(limit)) for name in _VISIBLE]
            )


app = typer.Typer(
    name="halation",
    cls=_Group,
    add_completion=True,
    rich_markup_mode=None,
    epilog=EXIT_CODES,
    help="A node-graph compositor for screen-space effects.",
)


@app.callback(invoke_without_command=True)
def main_options(
    context: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version and stop."),
    verbose: bool = typer.Option(False, "--verbose", help="With --version: also what halation doctor finds."),
) -> None:
    """Print the version, or the help where no command is given."""
    if version:
        print(f"halation {VERSION}")
        if verbose:
            from .doctor import doctor

            doctor()
        raise typer.Exit
    if verbose:
        raise typer.BadParameter("it goes with --version", param_hint="--verbose")
    if context.invoked_subcommand is None:
        print(context.get_help(), file=sys.stderr)
        raise typer.Exit(2)


def read_summary(name: str) -> str:
    """The docstring of a command. It is read from the code of the module, which is not run.

    To run the modules of all commands, and to read their options, takes half of the time of `halation --help`.
    """
    function = name.replace("-", "_")
    spec = find_spec(f".{function}", __package__)
    code: CodeType | None = spec.loader.get_code(spec.name) if spec and spec.loader else None  # type: ignore[attr-defined]
    bodies = [item for item in code.co_consts if isinstance(item, CodeType)] if code else []
    docstring = next((body.co_consts[0] for body in bodies if body.co_name == function), None)
    return docstring if isinstance(docstring, str) else ""


def run_process(arguments: Sequence[str]) -> int:
    """Run the one command of a process, which ends afterwards, and return its exit code. Nothing is raised."""
    if not has_memory_limit():
        return run(arguments)
    from .watchdog import run_limited

    try:
        return run_limited(lambda: run(arguments))
    except (RenderError, KeyboardInterrupt) as fault:
        return flush_output(report_failure(fault, _prints_json(arguments)))


def run(arguments: Sequence[str]) -> int:
    """Run one command and return its exit code. Nothing is raised."""
    as_json = _prints_json(arguments)
    try:
        if (memory := memory_limit()) < _LEAST_MEMORY:
            raise MemoryError(
                f"{memory / 2**20:.0f} MiB of memory are too few (ulimit -v): allow {_LEAST_MEMORY >> 20} MiB at least"
            )
        check_words(words := tuple(arguments))
        code = get_command(app).main(list(words), prog_name="halation", standalone_mode=False, obj=words)
    except SystemExit as end:  # so click ends completions (0), and when the program that read its help has ended (1)
        code = report_failure(BrokenPipeError(), as_json) if end.code else 0
    except (Exception, KeyboardInterrupt) as fault:
        code = report_failure(fault, as_json)
    return flush_output(code if isinstance(code, int) else 0)


def _prints_json(arguments: Sequence[str]) -> bool:
    return "--json" in arguments or arguments[:1] == ["worker"]


@cache
def _command(name: str) -> Any:
    from .options import add_root  # the help needs no options of commands

    function = name.replace("-", "_")
    command = getattr(import_module(f".{function}", __package__), function)
    alone = typer.Typer(add_completion=False, rich_markup_mode=None)
    alone.command(hidden=name in _HIDDEN)(catch_faults(command if name in WITHOUT_ROOT else add_root(command)))
    return get_command(alone)

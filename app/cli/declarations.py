"""What the commands declare, in the words of pages: docs/command-line.md and the manual pages are made from it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from typer.main import get_command

from .program import app


def list_commands() -> dict[str, Any]:
    """Every command by name, hidden ones too."""
    return dict(get_command(app).commands)  # pyright: ignore[reportAttributeAccessIssue, reportUnknownMemberType, reportUnknownArgumentType]


def list_arguments(command: Any) -> list[Any]:
    """The arguments of a command, in order."""
    return [parameter for parameter in command.params if parameter.param_type_name == "argument"]


def list_options(command: Any) -> list[Any]:
    """The options of a command that its help shows, without --help."""
    return [
        parameter
        for parameter in command.params
        if parameter.param_type_name == "option" and not parameter.hidden and parameter.name != "help"
    ]


def write_usage(name: str, command: Any) -> str:
    """How a command is called: with its arguments, and the options that it needs."""
    words = (write_argument(argument) for argument in list_arguments(command))
    return " ".join(["halation", name, *words, *_write_required(list_options(command))])


def write_argument(argument: Any) -> str:
    """An argument in a usage line: in brackets where it may be left out."""
    word = (argument.metavar or argument.name or "").upper().replace("[", "").replace("]", "")
    word += "..." if argument.nargs == -1 and not word.endswith("...") else ""
    return word if argument.required else f"[{word}]"


def list_flags(option: Any) -> list[str]:
    """The flags of an option, the shortest first; those that switch it off come last."""
    return [*sorted(option.opts, key=len), *option.secondary_opts]


def write_metavar(option: Any) -> str:
    """What follows the flags of an option; "" for a switch."""
    return "" if option.is_flag else option.metavar or (option.name or "").upper()


def _write_required(options: Iterable[Any]) -> Iterator[str]:
    for option in options:
        if option.required:
            yield f"{list_flags(option)[0]} {write_metavar(option)}"

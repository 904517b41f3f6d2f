"""The tables of docs/command-line.md, from what the commands declare."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from halation.cli.program import app
from typer.main import get_command

_EVERYWHERE = ("--json", "--root", "--timeout")
"""Flags that the page explains once."""
_BLOCK = re.compile(r"<!-- (?P<name>[\w-]+) -->\n.*?<!-- /(?P=name) -->", re.DOTALL)


def list_commands() -> dict[str, Any]:
    """Every command by name."""
    return dict(get_command(app).commands)  # pyright: ignore[reportAttributeAccessIssue]


def fill_tables(page: str) -> str:
    """The page with every table as the commands declare it."""
    commands = list_commands()
    return _BLOCK.sub(lambda match: describe_command(match["name"], commands[match["name"]]), page)


def describe_command(name: str, command: Any) -> str:
    """What the page says of a command between its marks: how to call it, and its arguments and flags."""
    arguments = [item for item in command.params if item.param_type_name == "argument"]
    options = [item for item in command.params if item.param_type_name == "option" and not item.hidden]
    usage = " ".join(["halation", name, *(_usage(item) for item in arguments), *_required_options(options)])
    rows = [(f"`{_usage(item)}`", item.help or "") for item in arguments]
    own = [item for item in options if item.name != "help" and not set(_EVERYWHERE) & set(item.opts)]
    rows += [(_flags(item), item.help or "") for item in own]
    lines = [f"| {head} | {_cell(text)} |" for head, text in rows]
    table = "\n".join(["", "| | |", "|---|---|", *lines, ""]) if rows else ""
    return f"<!-- {name} -->\n`{usage}`\n{table}<!-- /{name} -->"


def _usage(item: Any) -> str:
    word = (item.metavar or item.name or "").upper().replace("[", "").replace("]", "")
    word += "..." if item.nargs == -1 and not word.endswith("...") else ""
    return word if item.required else f"[{word}]"


def _required_options(options: list[Any]) -> Iterator[str]:
    for item in options:
        if item.required:
            yield f"{min(item.opts, key=len)} {item.metavar or (item.name or '').upper()}"


def _flags(item: Any) -> str:
    flags = ", ".join(f"`{flag}`" for flag in sorted(item.opts, key=len))
    argument = item.metavar or (item.name or "").upper()
    return flags if item.is_flag else f"{flags} `{argument}`".replace("|", "\\|")


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")

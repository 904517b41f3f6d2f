"""The tables of docs/command-line.md and of pages about single commands, from what the commands declare."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping
from typing import Any

from halation.cli.declarations import (
    list_arguments,
    list_commands,
    list_flags,
    list_options,
    write_argument,
    write_metavar,
    write_usage,
)

_EVERYWHERE = ("--json", "--root", "--timeout")
"""Flags of nearly all commands, which the text of the page explains."""
_SHARED_BY = 3
"""Options of so many commands have a table of their own, and the commands only name them."""
_SHARED = "command-line.md#shared-options"
_BLOCK = re.compile(r"<!-- (?P<name>[\w-]+) -->\n.*?<!-- /(?P=name) -->", re.DOTALL)


def fill_tables(page: str) -> str:
    """The page with every table as the commands declare it."""
    commands = list_commands()
    shared = find_shared_options(commands)

    def fill(match: re.Match[str]) -> str:
        name = match["name"]
        if name == "shared":
            return f"<!-- shared -->{_table(list(shared.items()))}<!-- /shared -->"
        text = describe_command(name, commands[name], shared)
        return text if "<!-- shared -->" in page else text.replace("(#shared-options)", f"({_SHARED})")

    return _BLOCK.sub(fill, page)


def find_shared_options(commands: Mapping[str, Any]) -> dict[str, str]:
    """The help of every argument and option that several commands declare in the same way, by its flags."""
    uses = Counter(
        (_flags(item), item.help)
        for command in commands.values()
        for item in command.params
        if item.name != "help" and not set(_EVERYWHERE) & set(item.opts)
    )
    return {flags: text for (flags, text), count in uses.items() if count >= _SHARED_BY}


def describe_command(name: str, command: Any, shared: Mapping[str, str]) -> str:
    """What the page says of a command between its marks: how to call it, and its arguments and flags."""
    arguments, options = list_arguments(command), list_options(command)
    rows = [(_flags(item), item.help or "") for item in arguments if shared.get(_flags(item)) != item.help]
    own = [item for item in options if not set(_EVERYWHERE) & set(item.opts)]
    rows += [(_flags(item), item.help or "") for item in own if shared.get(_flags(item)) != item.help]
    common = [_flags(item).split()[0].strip(",") for item in own if shared.get(_flags(item)) == item.help]
    line = f" with the [shared options](#shared-options) {', '.join(common)}" if common else ""
    return f"<!-- {name} -->\n`{write_usage(name, command)}`{line}\n{_table(rows)}<!-- /{name} -->"


def _table(rows: Collection[tuple[str, str]]) -> str:
    lines = [f"| {head} | {_cell(text)} |" for head, text in rows]
    return "\n".join(["", "| | |", "|---|---|", *lines, ""]) if rows else ""


def _flags(item: Any) -> str:
    if item.param_type_name == "argument":
        return f"`{write_argument(item)}`"
    flags = ", ".join(f"`{flag}`" for flag in list_flags(item))
    metavar = write_metavar(item)
    return f"{flags} `{metavar}`".replace("|", "\\|") if metavar else flags


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")

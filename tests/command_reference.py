"""The tables of docs/command-line.md, from what the commands declare."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from halation.cli.program import app
from typer.main import get_command

_EVERYWHERE = ("--json", "--root", "--timeout")
"""Flags of nearly all commands, which the text of the page explains."""
_SHARED_BY = 3
"""Options of so many commands have a table of their own, and the commands only name them."""
_BLOCK = re.compile(r"<!-- (?P<name>[\w-]+) -->\n.*?<!-- /(?P=name) -->", re.DOTALL)


def list_commands() -> dict[str, Any]:
    """Every command by name."""
    return dict(get_command(app).commands)  # pyright: ignore[reportAttributeAccessIssue]


def fill_tables(page: str) -> str:
    """The page with every table as the commands declare it."""
    commands = list_commands()
    shared = find_shared_options(commands)

    def fill(match: re.Match[str]) -> str:
        name = match["name"]
        if name == "shared":
            return f"<!-- shared -->{_table(list(shared.items()))}<!-- /shared -->"
        return describe_command(name, commands[name], shared)

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
    arguments = [item for item in command.params if item.param_type_name == "argument"]
    options = [item for item in command.params if item.param_type_name == "option" and not item.hidden]
    usage = " ".join(["halation", name, *(_usage(item) for item in arguments), *_required_options(options)])
    rows = [(_flags(item), item.help or "") for item in arguments if shared.get(_flags(item)) != item.help]
    own = [item for item in options if item.name != "help" and not set(_EVERYWHERE) & set(item.opts)]
    rows += [(_flags(item), item.help or "") for item in own if shared.get(_flags(item)) != item.help]
    common = [_flags(item).split()[0].strip(",") for item in own if shared.get(_flags(item)) == item.help]
    line = f" with the [shared options](#shared-options) {', '.join(common)}" if common else ""
    return f"<!-- {name} -->\n`{usage}`{line}\n{_table(rows)}<!-- /{name} -->"


def _table(rows: Collection[tuple[str, str]]) -> str:
    lines = [f"| {head} | {_cell(text)} |" for head, text in rows]
    return "\n".join(["", "| | |", "|---|---|", *lines, ""]) if rows else ""


def _usage(item: Any) -> str:
    word = (item.metavar or item.name or "").upper().replace("[", "").replace("]", "")
    word += "..." if item.nargs == -1 and not word.endswith("...") else ""
    return word if item.required else f"[{word}]"


def _required_options(options: list[Any]) -> Iterator[str]:
    for item in options:
        if item.required:
            yield f"{min(item.opts, key=len)} {item.metavar or (item.name or '').upper()}"


def _flags(item: Any) -> str:
    if item.param_type_name == "argument":
        return f"`{_usage(item)}`"
    flags = ", ".join(f"`{flag}`" for flag in sorted(item.opts, key=len))
    argument = item.metavar or (item.name or "").upper()
    return flags if item.is_flag else f"{flags} `{argument}`".replace("|", "\\|")


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")

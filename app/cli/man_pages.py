"""The manual pages `halation(1)`, `halation-render(1)`, ..., written from what the commands declare.

They are in the language of man(7), which groff and mandoc read.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

from typer.main import get_command

from ..version import VERSION
from .declarations import (
    list_arguments,
    list_commands,
    list_flags,
    list_options,
    write_argument,
    write_metavar,
    write_usage,
)
from .outcome import EXIT_CODES
from .program import app

_EXIT_CODE = re.compile(r"^(\d+) +(.+)$", re.M)


def write_man_pages() -> Mapping[str, str]:
    """The text of each page by its name, such as `halation-render.1`; one for each command that the help lists."""
    commands = {name: command for name, command in list_commands().items() if not command.hidden}
    pages = {f"halation-{name}.1": _write_page(name, command, commands) for name, command in commands.items()}
    return MappingProxyType({"halation.1": _write_overview(commands), **pages})


def _write_overview(commands: Mapping[str, Any]) -> str:
    usage = ("halation COMMAND [OPTIONS] [ARGUMENTS]", "halation COMMAND --help")
    lines = [*_write_head("halation", str(app.info.help)), ".SH SYNOPSIS"]
    lines += [line for words in usage for line in (".PP", f".B {_escape(words)}")]
    lines += [*_write_options(get_command(app)), ".SH COMMANDS"]
    for name, command in commands.items():
        lines += [".TP", f".BR halation\\-{_escape(name)} (1)", _escape(_read_paragraphs(command)[0])]
    return _join([*lines, *_write_exit_codes()])


def _write_page(name: str, command: Any, commands: Mapping[str, Any]) -> str:
    summary, *paragraphs = _read_paragraphs(command)
    lines = [*_write_head(f"halation-{name}", summary), ".SH SYNOPSIS"]
    lines += [f".B {_escape(write_usage(name, command))} [OPTIONS]", ".SH DESCRIPTION", _escape(summary)]
    lines += [line for paragraph in paragraphs for line in (".PP", _escape(paragraph))]
    lines += _write_options(command)
    others = [".BR halation (1)", *(f".BR halation\\-{_escape(other)} (1)" for other in commands if other != name)]
    return _join([*lines, *_write_exit_codes(), ".SH SEE ALSO", ",\n".join(others)])


def _write_head(name: str, summary: str) -> list[str]:
    title = f'.TH {name.upper()} 1 "" "Halation {VERSION}" "Halation"'
    return [title, ".SH NAME", f"{_escape(name)} \\- {_escape(summary).rstrip('.')}"]


def _write_options(command: Any) -> Iterator[str]:
    """The section of arguments and options; none for a command without any."""
    entries = [(f"\\fI{_escape(write_argument(item))}\\fR", item.help) for item in list_arguments(command)]
    entries += [(_write_flags(item), item.help) for item in list_options(command)]
    if entries:
        yield ".SH OPTIONS"
    for head, text in entries:
        yield from (".TP", head, _escape(text or ""))


def _write_flags(option: Any) -> str:
    flags = ", ".join(f"\\fB{_escape(flag)}\\fR" for flag in list_flags(option))
    metavar = write_metavar(option)
    return f"{flags} \\fI{_escape(metavar)}\\fR" if metavar else flags


def _write_exit_codes() -> Iterator[str]:
    yield ".SH EXIT STATUS"
    for code, meaning in _EXIT_CODE.findall(EXIT_CODES):
        yield from (".TP", code, _escape(meaning))


def _read_paragraphs(command: Any) -> list[str]:
    return [" ".join(paragraph.split()) for paragraph in (command.help or "").split("\n\n")]


def _escape(text: str) -> str:
    """A line of text that means itself: a hyphen is the character of options, a dot at the start is no request."""
    text = " ".join(text.split()).replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{text}" if text.startswith((".", "'")) else text


def _join(lines: list[str]) -> str:
    return "\n".join(lines) + "\n"

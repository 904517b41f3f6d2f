"""Tokens in texts that are drawn: `{frame}`, `{timecode}`, `{file}`, `{=frame / 24}` and others become words.

What depends on the clock of the machine is read only where a text asks for it, so that other renders are the same
each time.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import PurePath
from types import MappingProxyType
from typing import Protocol

from halation.nodes import Scalar, Size
from msgspec import Struct

from ...errors import GraphError
from ...graph import Port
from ...graph.expressions import Expression
from ...resources.picture import Picture
from .expand import FlatGraph
from .references import ReferencedPictures

_TOKEN = re.compile(r"\{\{|\}\}|\{([^{}]*)\}|[{}]")

MOST_DIGITS = 32
"""The most digits of a frame: no file name has more."""


class TextClock(Protocol):
    """The time and the size of a node that draws text."""

    @property
    def frame(self) -> int: ...
    @property
    def rate(self) -> float: ...
    @property
    def start(self) -> int: ...
    @property
    def size(self) -> Size: ...


class TokenSources(Struct, frozen=True):
    """What tokens ask of the world: the file of the picture, "" for none; its header; the date."""

    find_file: Callable[[], str]
    read_attributes: Callable[[str], Mapping[str, str]]
    read_date: Callable[[], str]


def expand_tokens(text: str, clock: TextClock, sources: TokenSources) -> str:
    """A text with its tokens replaced; `{{` and `}}` are braces. Raises GraphError for an unknown token."""

    def replace(match: re.Match[str]) -> str:
        whole, content = match.group(0), match.group(1)
        if whole in ("{{", "}}"):
            return whole[0]
        if content is None:
            raise GraphError(f"the text has a single '{whole}': write {whole}{whole} for a brace that is drawn")
        return _expand(content.strip(), clock, sources)

    return _TOKEN.sub(replace, text)


def _expand(content: str, clock: TextClock, sources: TokenSources) -> str:
    if content.startswith("="):
        return _write_number(_evaluate(content[1:], clock))
    name, _, detail = (part.strip() for part in content.partition(":"))
    if name == "meta" and detail:
        file = sources.find_file()
        return _find_attribute(sources.read_attributes(file), detail) if file else ""
    if name == "frame" and (not detail or (detail.isdigit() and int(detail) <= MOST_DIGITS)):
        return f"{clock.frame:0{int(detail or 0)}d}"
    if detail or name not in _WORDS:
        names = ", ".join(f"{{{word}}}" for word in ("frame", "frame:4", *_WORDS, "meta:NAME", "=FORMULA"))
        raise GraphError(
            f"the text has the token '{{{content}}}', which is unknown: there are {names}; "
            f"write {{{{{content}}}}} to draw braces"
        )
    return _WORDS[name](clock, sources)


def _evaluate(formula: str, clock: TextClock) -> Scalar:
    def refuse(name: str) -> Scalar:
        raise GraphError(
            f"the formula '{formula.strip()}' in the text uses '{name}', which it cannot: it can use frame, time, "
            "rate and functions"
        )

    return Expression(formula).evaluate(clock.frame, (clock.frame - clock.start) / clock.rate, clock.rate, refuse)


def _write_number(number: Scalar) -> str:
    if isinstance(number, tuple):
        return ", ".join(map(_write_number, number))
    if isinstance(number, float):
        return str(int(number)) if number.is_integer() and abs(number) < 1e15 else f"{number:.6g}"
    return str(number)


def _find_attribute(attributes: Mapping[str, str], name: str) -> str:
    """An attribute by its name, in small or capital letters; "" if the picture has none."""
    return next((text for key, text in attributes.items() if key.lower() == name.lower()), "")


def write_timecode(frame: int, rate: float) -> str:
    """The timecode of a frame, HH:MM:SS:FF, without dropped numbers; frame 0 is 00:00:00:00."""
    base = max(round(rate), 1)
    sign, number = ("-" if frame < 0 else ""), abs(frame)
    seconds, rest = divmod(number, base)
    return f"{sign}{seconds // 3600:02d}:{seconds // 60 % 60:02d}:{seconds % 60:02d}:{rest:02d}"


_WORDS: Mapping[str, Callable[[TextClock, TokenSources], str]] = MappingProxyType(
    {
        "timecode": lambda clock, _: write_timecode(clock.frame, clock.rate),
        "seconds": lambda clock, _: f"{(clock.frame - clock.start) / clock.rate:.2f}",
        "rate": lambda clock, _: f"{clock.rate:.6g}",
        "size": lambda clock, _: f"{clock.size[0]}x{clock.size[1]}",
        "file": lambda _, sources: PurePath(sources.find_file()).name,
        "path": lambda _, sources: sources.find_file(),
        "date": lambda _, sources: sources.read_date(),
    }
)
"""Tokens without a detail, and what they become."""


def find_source_picture(flat: FlatGraph, named: ReferencedPictures, node: str, socket: str) -> tuple[Picture, str]:
    """The first picture that an input of a node is made of, and its owner. Raises LookupError if there is none."""
    owners = {owner: picture for picture, owner in named}
    ports, visited = [Port(node, socket)], set[Port]()
    while ports:
        port = ports.pop(0)
        source = flat.find_source(port) if port not in visited else None
        visited.add(port)
        if source is None:
            continue
        if (owner := f"{source}" if source in flat.inputs else source.node) in owners:
            return owners[owner], owner
        if source.node in flat.nodes:
            ports += [Port(source.node, name) for name in flat.nodes[source.node].inputs]
    raise LookupError(node)

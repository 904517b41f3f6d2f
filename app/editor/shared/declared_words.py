"""Words of declarations in the chosen language: names of nodes, values, sockets and choices. Ids stay English."""

from __future__ import annotations

import inspect
from collections.abc import Iterable

from halation.nodes import Node

from ...language.translation import translate


def spell_out(name: str) -> str:
    """An id with spaces in place of underscores, for the user."""
    return name.replace("_", " ")


def name_value(name: str) -> str:
    """The name of a value or a socket, from its label or its id."""
    return translate(spell_out(name), "value")


def name_choice(choice: str) -> str:
    """What a choice of a value is called."""
    return translate(choice, "choice")


def name_choices(choices: Iterable[str]) -> tuple[str, ...]:
    """What the choices of a value are called, in their order."""
    return tuple(map(name_choice, choices))


def name_category(category: str) -> str:
    """The name of a menu of nodes, of a tag of presets, or of another heading of the catalog."""
    return translate(spell_out(category), "category")


def name_type(title: str) -> str:
    """The title of a type of nodes, within a sentence or a list."""
    return translate(title, "node")


def head_type(title: str) -> str:
    """The title of a type of nodes, as a heading: in English each word begins with a capital letter."""
    words = name_type(title)
    return " ".join(map(raise_first, words.split())) if words == title else raise_first(words)


def name_preset(name: str) -> str:
    """What a preset is called, from the name of its file."""
    return translate(spell_out(name), "preset")


def read_paragraphs(kind: type[Node]) -> tuple[str, ...]:
    """The paragraphs of what a type of nodes says about itself, in English; the first one sums it up."""
    doc = inspect.getdoc(kind) or ""
    return tuple(" ".join(part.replace("`", "").split()) for part in doc.split("\n\n") if part.strip())


def describe_type(kind: type[Node]) -> tuple[str, ...]:
    """The paragraphs of what a type of nodes says about itself."""
    return tuple(map(translate, read_paragraphs(kind)))


def summarize_type(kind: type[Node]) -> str:
    """What a type of nodes does, in a sentence."""
    return next(map(translate, read_paragraphs(kind)), "")


def raise_first(text: str) -> str:
    """The text with a capital letter at its beginning."""
    return text[:1].upper() + text[1:]

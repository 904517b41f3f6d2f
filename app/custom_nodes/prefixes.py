"""Names of their own for all that a user's text defines: what it is fused with may use the same ones."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from ..glsl.operands import TYPE, skip_lengths
from ..glsl.tokens import GlslFault, GlslToken, mask_directives, match_brackets, read_tokens


def prefix_names(code: str, functions: Collection[str], prefix: str) -> str:
    """The text with a prefix on its functions, structs and variables outside of functions.

    Members keep their names: after a dot `r` is a channel, whatever else is called so.
    """
    tokens = read_tokens(mask_directives(code))
    try:
        partners = match_brackets(tokens, code, len(tokens))
    except GlslFault:
        partners = dict[int, int]()  # the driver refuses it
    structs = {tokens[at + 1].text for at, token in enumerate(tokens[:-1]) if token.text == "struct"}
    names = {*functions, *structs, *_find_globals(tokens, partners, structs)} - {"{"}
    members = _find_members(tokens, partners)
    parts, place = list[str](), 0
    for at, token in enumerate(tokens):
        if token.text in names and at not in members and not (at and tokens[at - 1].text == "."):
            parts += [code[place : token.start], prefix]
            place = token.start
    return "".join([*parts, code[place:]])


def _find_globals(tokens: Sequence[GlslToken], partners: Mapping[int, int], structs: Collection[str]) -> set[str]:
    """The variables that are declared outside of functions."""
    names = set[str]()
    at = 0
    while at < len(tokens):
        if TYPE.fullmatch(tokens[at].text) or tokens[at].text in structs:
            place = skip_lengths(tokens, partners, at + 1)
            while place + 1 < len(tokens) and tokens[place].is_word and tokens[place + 1].text in ("=", ";", ",", "["):
                names.add(tokens[place].text)
                while place < len(tokens) and tokens[place].text not in (",", ";"):
                    place = partners.get(place, place) + 1
                if place >= len(tokens) or tokens[place].text == ";":
                    break
                place += 1
            at = place - 1
        at = partners.get(at, at) + 1 if at < len(tokens) and tokens[at].text in ("(", "[", "{") else at + 1
    return names


def _find_members(tokens: Sequence[GlslToken], partners: Mapping[int, int]) -> set[int]:
    """The tokens that name members where a struct declares them: what follows a type."""
    members = set[int]()
    for at, token in enumerate(tokens[:-2]):
        opened = at + 2 if tokens[at + 2].text == "{" else at + 1
        if token.text != "struct" or tokens[opened].text != "{" or opened not in partners:
            continue
        place, typed = opened + 1, False
        while place < partners[opened]:
            text = tokens[place].text
            if text in ("[", "("):
                place = partners[place]
            elif text == ";":
                typed = False
            elif tokens[place].is_word and typed:
                members.add(place)
            elif tokens[place].is_word and text not in ("highp", "mediump", "lowp", "const"):
                typed = True
            place += 1
    return members

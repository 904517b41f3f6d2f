"""What each layer of a render is, and how that is known.

What a name means is looked up in the table of the renderer that made the file, then in those of the others, then by how
the name is built, and last by what the layer is made of. A layer that may be several things stays without a role.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from types import MappingProxyType

from ..media.channels import is_depth
from ..media.layers import Layer, normalize_name
from .naming import HINTS, PATTERNS, SCHEMES, Renderer, Role

_GROUP = re.compile(r"(?:combined|rgba?|beauty)_(.+)", re.IGNORECASE)
_RANKS = re.compile(r"u?(?P<name>.*crypto.*?)(?P<rank>\d\d)?", re.IGNORECASE)
_CRYPTOMATTES = (
    ("material", Role.CRYPTOMATTE_MATERIAL),
    ("mtl", Role.CRYPTOMATTE_MATERIAL),
    ("asset", Role.CRYPTOMATTE_ASSET),
    ("object", Role.CRYPTOMATTE_OBJECT),
    ("node", Role.CRYPTOMATTE_OBJECT),
)
_EYES = ("left", "right")
_MANIFEST = re.compile(r"cryptomatte/\w+/name")
_VECTORS = (Role.NORMAL, Role.POSITION, Role.VELOCITY)


class Grounds(IntEnum):
    """What a role rests on, the firmest first."""

    HEADER = 0
    TABLE = 1
    OTHER_TABLE = 2
    PATTERN = 3
    SHAPE = 4
    NONE = 5


@dataclass(frozen=True)
class Pass:
    """A layer and its role, which is None where `candidates` says what it may be, or nothing is known.

    `rank` counts what would be better layers for the same role; `name` is the word that says what it is,
    `group` the view or view layer that it belongs to.
    """

    layer: Layer
    role: Role | None
    grounds: Grounds
    reason: str
    candidates: tuple[Role, ...] = ()
    rank: int = 0
    name: str = ""
    group: str = ""


@dataclass(frozen=True)
class Maker:
    """Who made a file, and how that is known; None where nothing says so."""

    renderer: Renderer | None
    reason: str


def maker_of(attributes: Mapping[str, object], layers: Sequence[Layer]) -> Maker:
    """The renderer: by what it writes into headers, else by names of layers that only it uses."""
    for name, value in sorted(attributes.items(), key=lambda item: item[0] != "Software"):  # it tells the version
        line = f"{name}={value}"
        for renderer, scheme in SCHEMES.items():
            if scheme.marks.fullmatch(line):
                said = f"{name} is '{value}'" if name == "Software" else f"its header has {name}"
                return Maker(renderer, said)
    own = {renderer: _own_names(renderer, layers) for renderer in SCHEMES}
    most = sorted(own.items(), key=lambda item: -len(item[1]))
    if len(most[0][1]) > len(most[1][1]):
        return Maker(most[0][0], f"nobody else calls layers {' or '.join(most[0][1][:3])}")
    return Maker(None, "neither its header nor its layers say who made it")


def passes_of(
    layers: Sequence[Layer],
    attributes: Mapping[str, object],
    renderer: Renderer | None,
    seen_by: Mapping[int, str] = MappingProxyType({}),
) -> tuple[Pass, ...]:
    """What every layer is; `seen_by` names the views of those parts that are of one."""
    manifests = {normalize_name(str(value)) for name, value in attributes.items() if _MANIFEST.fullmatch(name)}
    several = attributes.get("multiView")
    views = [str(view).casefold() for view in several] if isinstance(several, tuple) else []
    readings = [_read(layer, views, seen_by.get(layer.part, "")) for layer in layers]
    found = [
        replace(_pass(layer, word, renderer, manifests), name=word, group=group)
        for layer, (word, group) in zip(layers, readings, strict=True)
    ]
    if not any(item.role is Role.BEAUTY for item in found):
        found = list(_with_beauty(found))
    return tuple(found)


def chosen(passes: Iterable[Pass], role: Role) -> tuple[Pass, ...]:
    """The passes that have the best claim to a role: several only where nothing decides between them.

    Of several view layers that of the picture counts.
    """
    passes = tuple(passes)
    home = next((item.group for item in passes if item.role is Role.BEAUTY), "")

    def claim(item: Pass) -> tuple[int, ...]:
        return (item.group != home, item.grounds, item.rank)

    claims = [item for item in passes if item.role is role]
    best = min(map(claim, claims), default=())
    return tuple(item for item in claims if claim(item) == best)


def _read(layer: Layer, views: Sequence[str], view: str) -> tuple[str, str]:
    """The word that says what a layer is, and the view or view layer that it belongs to.

    OpenEXR has `view.channel` and `layer.view.channel`, the first of `views` goes without saying, and parts that are
    of a `view` often end in its name.
    """
    known = {*_EYES, *views}
    words = layer.name.split(".")
    mine = [word.casefold() for word in words if word.casefold() in known] or ([view.casefold()] if view else [])
    ending = re.compile(rf"(?<=.)[_ -]?{re.escape(view)}$" if view else r"(?!)", re.IGNORECASE)
    named = [ending.sub("", word) for word in words if word.casefold() not in known]
    last = named[-1] if named else "".join(layer.channels)
    above = [word for word in named[:-1] if normalize_name(word) != normalize_name(last)]
    return last, ".".join([*above, *(name for name in mine if name != (views or [""])[0])])


def _pass(layer: Layer, name: str, renderer: Renderer | None, manifests: set[str]) -> Pass:
    word = normalize_name(name)
    for found in (
        _cryptomatte(layer, manifests),
        _by_table(layer, word, renderer),
        _light_group(layer, name),
        _by_pattern(layer, word),
        _by_shape(layer, word),
    ):
        if found is not None:
            return found
    return Pass(layer, None, Grounds.NONE, "its name says nothing that is known")


def _cryptomatte(layer: Layer, manifests: set[str]) -> Pass | None:
    """A layer of ids and coverages: its manifest names it, or its own name does."""
    full, last = normalize_name(layer.full_name), layer.name.rpartition(".")[2]
    match = _RANKS.fullmatch(normalize_name(last))
    listed = full[:-2] in manifests and full[-2:].isdigit()
    if match is None and not listed:
        return None
    role = next((role for part, role in _CRYPTOMATTES if part in full), Role.CRYPTOMATTE)
    rank = match["rank"] if match else full[-2:]
    if rank is None:
        return Pass(layer, None, Grounds.NONE, "a picture of a cryptomatte to look at, not its ids")
    if len(layer.channels) != 4 or layer.format not in ("float32", "uint32"):
        return Pass(layer, None, Grounds.NONE, "named like a cryptomatte, but its ids need four channels of 32 bits")
    reason = "the manifest in the header names it" if listed else "it is named like a cryptomatte"
    return Pass(layer, role, Grounds.HEADER if listed else Grounds.PATTERN, reason, rank=int(rank))


def _by_table(layer: Layer, word: str, renderer: Renderer | None) -> Pass | None:
    """By what the renderer of the file calls it, else by what the others do, as long as they agree."""
    if renderer is not None and (known := SCHEMES[renderer].role(word)):
        role, rank = known
        return Pass(layer, role, Grounds.TABLE, f"{renderer.value}'s name for {role.words}", rank=rank)
    claims: dict[Role, list[str]] = {}
    ranks: list[int] = []
    for other, scheme in SCHEMES.items():
        if known := scheme.role(word):
            claims.setdefault(known[0], []).append(other.value)
            ranks.append(known[1])
    if not claims:
        return None
    if len(claims) > 1:
        told = "; ".join(f"{role.words} in {_listed(names)}" for role, names in claims.items())
        return Pass(layer, None, Grounds.NONE, f"the name means {told}", tuple(claims))
    role, names = next(iter(claims.items()))
    return Pass(layer, role, Grounds.OTHER_TABLE, f"the name for {role.words} in {_listed(names)}", rank=min(ranks))


def _light_group(layer: Layer, last: str) -> Pass | None:
    match = _GROUP.fullmatch(last)
    if match is None or layer.is_data:
        return None
    return Pass(layer, Role.LIGHT_GROUP, Grounds.PATTERN, f"named like the light of the group '{match[1]}'")


def _by_pattern(layer: Layer, word: str) -> Pass | None:
    """By how the name is built."""
    if is_depth(word) and len(layer.channels) <= 3:
        return Pass(layer, Role.DEPTH, Grounds.PATTERN, "a usual name of depth")
    fits = [role for role, pattern in PATTERNS.items() if pattern.fullmatch(word)]
    if len(fits) == 1:
        return Pass(layer, fits[0], Grounds.PATTERN, f"a usual name of {fits[0].words}")
    return Pass(layer, None, Grounds.NONE, "a name of several things", tuple(fits)) if fits else None


def _by_shape(layer: Layer, word: str) -> Pass | None:
    """By its channels; a word in the name may narrow down what a vector is, but decides nothing."""
    letters = "".join(channel.casefold() for channel in layer.channels)
    if letters == "z":
        return Pass(layer, Role.DEPTH, Grounds.SHAPE, "its only channel is Z")
    hints = tuple(role for role, hint in HINTS.items() if hint.fullmatch(word))
    if hints == (Role.MATTE,) and len(layer.channels) == 1:
        return Pass(layer, Role.MATTE, Grounds.SHAPE, "one channel, and a word for matte in its name")
    if hints:
        return Pass(layer, None, Grounds.NONE, f"its name has a word for {_listed([r.words for r in hints])}", hints)
    if letters == "xyz":
        return Pass(layer, None, Grounds.NONE, "a vector of three, of which the name says nothing", _VECTORS)
    if letters in ("uv", "xy"):
        return Pass(layer, None, Grounds.NONE, "two numbers, of which the name says nothing", (Role.UV, Role.VELOCITY))
    return None


def _with_beauty(passes: Sequence[Pass]) -> Iterator[Pass]:
    """The same where nothing is called a picture: the first color layer without a role is."""
    free = [item for item in passes if item.role is None and not item.candidates and not item.layer.is_data]
    for item in passes:
        if free and item is free[0]:
            only = "only" if len(free) == 1 else "first"
            reason = f"the {only} layer of color that is nothing else"
            yield replace(item, role=Role.BEAUTY, grounds=Grounds.SHAPE, reason=reason)
        else:
            yield item


def _own_names(renderer: Renderer, layers: Sequence[Layer]) -> list[str]:
    """Names of layers that the table of this renderer has and no other."""
    found: list[str] = []
    for layer in layers:
        last = layer.name.rpartition(".")[2]
        users = [other for other, scheme in SCHEMES.items() if scheme.role(normalize_name(last))]
        if users == [renderer]:
            found.append(last)
    return found


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"

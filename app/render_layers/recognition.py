"""Recognizes the layers of a render, with the reason for each.

A name is looked up in the table of the renderer that made the file, then in those of the others, then by its pattern,
and last by the channels of the layer. A layer that may have several roles gets none.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from types import MappingProxyType

from msgspec import Struct
from msgspec.structs import replace

from ..media.channels import is_depth
from ..media.layers import Layer, normalize_name, suggest_layers
from .naming import HINTS, PATTERNS, SCHEMES, RenderProgram, Role

_GROUP = re.compile(r"(?:combined|rgba?|beauty|(?:vray)?light_?select)_(.+)", re.IGNORECASE)
_KARMA_GROUP = re.compile(r"C_(.+)")
"""Karma splits its beauty, C, by the tag that lights have for light path expressions (LPE Tag in Houdini's manual)."""

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


class RoleGrounds(IntEnum):
    """The grounds for a role, the most certain first."""

    HEADER = 0
    TABLE = 1
    OTHER_TABLE = 2
    PATTERN = 3
    SHAPE = 4
    NONE = 5


class RenderPass(Struct, frozen=True):
    """A layer and its role. The role is None if it is unknown, or if `candidates` has several.

    `rank` counts what would be better layers for the same role; `name` is the word that says what it is,
    `group` the view or view layer that it belongs to.
    """

    layer: Layer
    role: Role | None
    grounds: RoleGrounds
    reason: str
    candidates: tuple[Role, ...] = ()
    rank: int = 0
    name: str = ""
    group: str = ""


class FileMaker(Struct, frozen=True):
    """The renderer of a file, and the reason; None if it is unknown."""

    renderer: RenderProgram | None
    reason: str


def find_maker(attributes: Mapping[str, object], layers: Sequence[Layer]) -> FileMaker:
    """The renderer of a file: by attributes of its header, else by layer names that only it uses."""
    for name, value in sorted(attributes.items(), key=lambda item: item[0] != "Software"):  # it has the version
        line = f"{name}={value}"
        for renderer, scheme in SCHEMES.items():
            if scheme.marks.fullmatch(line):
                reason = f"{name} is '{value}'" if name == "Software" else f"its header has {name}"
                return FileMaker(renderer, reason)
    own = {renderer: _find_own_names(renderer, layers) for renderer in SCHEMES}
    by_count = sorted(own.items(), key=lambda item: -len(item[1]))
    if len(by_count[0][1]) > len(by_count[1][1]):
        return FileMaker(by_count[0][0], f"nobody else calls layers {' or '.join(by_count[0][1][:3])}")
    return FileMaker(None, "neither its header nor its layers say who made it")


def recognize_passes(
    layers: Sequence[Layer],
    attributes: Mapping[str, object],
    renderer: RenderProgram | None,
    seen_by: Mapping[int, str] = MappingProxyType({}),
) -> tuple[RenderPass, ...]:
    """The role of every layer; `seen_by` names the views of parts that have one."""
    manifests = {normalize_name(str(value)) for name, value in attributes.items() if _MANIFEST.fullmatch(name)}
    view_names = attributes.get("multiView")
    views = [str(view).casefold() for view in view_names] if isinstance(view_names, tuple) else []
    readings = [_read_name(layer, views, seen_by.get(layer.part, "")) for layer in layers]
    passes = [
        replace(_recognize_pass(layer, word, renderer, manifests), name=word, group=group)
        for layer, (word, group) in zip(layers, readings, strict=True)
    ]
    if not any(item.role is Role.BEAUTY for item in passes):
        passes = list(_choose_beauty(passes))
    return tuple(passes)


def find_light_groups(passes: Iterable[RenderPass]) -> dict[str, Layer]:
    """The layers of light groups by the names of the groups, in the view layer of the picture."""
    passes = tuple(passes)
    home = next((item.group for item in passes if item.role is Role.BEAUTY), "")
    groups = [item for item in passes if item.role is Role.LIGHT_GROUP and item.group == home]
    matches = [(item, _GROUP.fullmatch(item.name) or _KARMA_GROUP.fullmatch(item.name)) for item in groups]
    return {match[1]: item.layer for item, match in matches if match}


def find_named_role(name: str) -> Role | None:
    """The role that a name has in every renderer that uses it; None for none, or several."""
    word = normalize_name(name.rpartition(".")[2])
    roles = {entry[0] for scheme in SCHEMES.values() if (entry := scheme.find_role(word))}
    if not roles:
        roles = {Role.DEPTH} if is_depth(word) else {role for role, fits in PATTERNS.items() if fits.fullmatch(word)}
    return roles.pop() if len(roles) == 1 else None


def best_claims(passes: Iterable[RenderPass], role: Role) -> tuple[RenderPass, ...]:
    """The passes with the best claim to a role; several if nothing decides between them.

    Of several view layers, that of the picture counts.
    """
    passes = tuple(passes)
    home = next((item.group for item in passes if item.role is Role.BEAUTY), "")

    def claim(item: RenderPass) -> tuple[int, ...]:
        return (item.group != home, item.grounds, item.rank)

    claims = [item for item in passes if item.role is role]
    best = min(map(claim, claims), default=())
    return tuple(item for item in claims if claim(item) == best)


def suggest_by_role(passes: Sequence[RenderPass], name: str, role: Role | None = None) -> list[str]:
    """Layers that the user may mean by a name that does not exist: of the role of that name, or of `role`, else those
    with a similar spelling and no other role."""
    role = role or find_named_role(name)
    best = best_claims(passes, role) if role else ()
    if len(best) == 1:
        return [best[0].layer.name]
    others = {item.layer.name for item in passes if item.role is not None} if role else set[str]()
    return [near for near in suggest_layers([item.layer for item in passes], name) if near not in others]


def _read_name(layer: Layer, views: Sequence[str], view: str) -> tuple[str, str]:
    """The word in a name that tells the role, and the view or view layer before it.

    OpenEXR has `view.channel` and `layer.view.channel`. The first of `views` is not written, and parts of a `view`
    often end in its name.
    """
    view_words = {*_EYES, *views}
    words = layer.name.split(".")
    own_views = [word.casefold() for word in words if word.casefold() in view_words] or (
        [view.casefold()] if view else []
    )
    ending = re.compile(rf"(?<=.)[_ -]?{re.escape(view)}$" if view else r"(?!)", re.IGNORECASE)
    name_words = [ending.sub("", word) for word in words if word.casefold() not in view_words]
    last = name_words[-1] if name_words else "".join(layer.channels)
    above = [word for word in name_words[:-1] if normalize_name(word) != normalize_name(last)]
    return last, ".".join([*above, *(name for name in own_views if name != (views or [""])[0])])


def _recognize_pass(layer: Layer, name: str, renderer: RenderProgram | None, manifests: set[str]) -> RenderPass:
    word = normalize_name(name)
    for recognized in (
        _recognize_cryptomatte(layer, manifests),
        _recognize_by_table(layer, word, renderer),
        _recognize_light_group(layer, name, renderer),
        _recognize_by_pattern(layer, word),
        _recognize_by_channels(layer, word),
    ):
        if recognized is not None:
            return recognized
    return RenderPass(layer, None, RoleGrounds.NONE, "its name says nothing that is known")


def _recognize_cryptomatte(layer: Layer, manifests: set[str]) -> RenderPass | None:
    """A cryptomatte layer: it is named by its manifest, or by its own name."""
    full, last = normalize_name(layer.full_name), layer.name.rpartition(".")[2]
    match = _RANKS.fullmatch(normalize_name(last))
    is_in_manifest = full[:-2] in manifests and full[-2:].isdigit()
    if match is None and not is_in_manifest:
        return None
    role = next((role for part, role in _CRYPTOMATTES if part in full), Role.CRYPTOMATTE)
    rank = match["rank"] if match else full[-2:]
    if rank is None:
        return RenderPass(layer, None, RoleGrounds.NONE, "a picture of a cryptomatte to look at, not its ids")
    if len(layer.channels) != 4 or layer.format not in ("float32", "uint32"):
        return RenderPass(
            layer, None, RoleGrounds.NONE, "named like a cryptomatte, but its ids need four channels of 32 bits"
        )
    reason = "the manifest in the header names it" if is_in_manifest else "it is named like a cryptomatte"
    return RenderPass(
        layer, role, RoleGrounds.HEADER if is_in_manifest else RoleGrounds.PATTERN, reason, rank=int(rank)
    )


def _recognize_by_table(layer: Layer, word: str, renderer: RenderProgram | None) -> RenderPass | None:
    """The role by the table of the file's renderer, else by the others if they agree."""
    if renderer is not None and (entry := SCHEMES[renderer].find_role(word)):
        role, rank = entry
        return RenderPass(layer, role, RoleGrounds.TABLE, f"{renderer.value}'s name for {role.words}", rank=rank)
    claims: dict[Role, list[str]] = {}
    ranks: list[int] = []
    for program, scheme in SCHEMES.items():
        if entry := scheme.find_role(word):
            claims.setdefault(entry[0], []).append(program.value)
            ranks.append(entry[1])
    if not claims:
        return None
    if len(claims) > 1:
        claims_text = "; ".join(f"{role.words} in {_join_names(names)}" for role, names in claims.items())
        return RenderPass(layer, None, RoleGrounds.NONE, f"the name means {claims_text}", tuple(claims))
    role, names = next(iter(claims.items()))
    return RenderPass(
        layer, role, RoleGrounds.OTHER_TABLE, f"the name for {role.words} in {_join_names(names)}", rank=min(ranks)
    )


def _recognize_light_group(layer: Layer, last: str, renderer: RenderProgram | None) -> RenderPass | None:
    match = _GROUP.fullmatch(last) or (_KARMA_GROUP.fullmatch(last) if renderer is RenderProgram.KARMA else None)
    if match is None or layer.is_data:
        return None
    return RenderPass(layer, Role.LIGHT_GROUP, RoleGrounds.PATTERN, f"named like the light of the group '{match[1]}'")


def _recognize_by_pattern(layer: Layer, word: str) -> RenderPass | None:
    """The role by the pattern of the name."""
    if is_depth(word) and len(layer.channels) <= 3:
        return RenderPass(layer, Role.DEPTH, RoleGrounds.PATTERN, "a usual name of depth")
    fits = [role for role, pattern in PATTERNS.items() if pattern.fullmatch(word)]
    if len(fits) == 1:
        return RenderPass(layer, fits[0], RoleGrounds.PATTERN, f"a usual name of {fits[0].words}")
    return RenderPass(layer, None, RoleGrounds.NONE, "a name of several things", tuple(fits)) if fits else None


def _recognize_by_channels(layer: Layer, word: str) -> RenderPass | None:
    """The role by the channels; a word in the name may narrow down the role of a vector, but does not decide."""
    letters = "".join(channel.casefold() for channel in layer.channels)
    if letters == "z":
        return RenderPass(layer, Role.DEPTH, RoleGrounds.SHAPE, "its only channel is Z")
    hints = tuple(role for role, hint in HINTS.items() if hint.fullmatch(word))
    if hints == (Role.MATTE,) and len(layer.channels) == 1:
        return RenderPass(layer, Role.MATTE, RoleGrounds.SHAPE, "one channel, and a word for matte in its name")
    if hints:
        return RenderPass(
            layer, None, RoleGrounds.NONE, f"its name has a word for {_join_names([r.words for r in hints])}", hints
        )
    if letters == "xyz":
        return RenderPass(layer, None, RoleGrounds.NONE, "a vector of three, of which the name says nothing", _VECTORS)
    if letters in ("uv", "xy"):
        return RenderPass(
            layer, None, RoleGrounds.NONE, "two numbers, of which the name says nothing", (Role.UV, Role.VELOCITY)
        )
    return None


def _choose_beauty(passes: Sequence[RenderPass]) -> Iterator[RenderPass]:
    """The same passes; if none has the name of the picture, the first color layer without a role becomes it."""
    free = [item for item in passes if item.role is None and not item.candidates and not item.layer.is_data]
    for item in passes:
        if free and item is free[0]:
            only = "only" if len(free) == 1 else "first"
            reason = f"the {only} layer of color that is nothing else"
            yield replace(item, role=Role.BEAUTY, grounds=RoleGrounds.SHAPE, reason=reason)
        else:
            yield item


def _find_own_names(renderer: RenderProgram, layers: Sequence[Layer]) -> list[str]:
    """Layer names that only the table of this renderer has."""
    names: list[str] = []
    for layer in layers:
        last = layer.name.rpartition(".")[2]
        users = [program for program, scheme in SCHEMES.items() if scheme.find_role(normalize_name(last))]
        if users == [renderer]:
            names.append(last)
    return names


def _join_names(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"

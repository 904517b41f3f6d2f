"""The layers of a file: what renderers call their channels, sorted into named groups.

A channel is `[view layer.]layer.component`; a part of a multi-part file may give the name instead.
"""

from __future__ import annotations

import difflib
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from msgspec import Struct
from msgspec.structs import replace

from ..errors import InputError

_FAMILIES = (("r", "g", "b", "a"), ("red", "green", "blue", "alpha"), ("y", "a"), ("x", "y", "z", "w"), ("u", "v", "a"))
_BEAUTY = ("combined", "beauty", "rgba", "rgb", "c", "ci")
DATA_NAMES = {
    "cryptomatte": r"crypto.*",
    "depth": r".*depth.*|z",
    "position": r".*position|p",
    "normal": r".*normals?|n|ng",
    "velocity": r".*motion.*|.*velocity|vector",
    "matte": r".*mattes?|.*masks?",
    "uv": r"uvs?|st",
    "id": r"(object|material|prim|node|render)?id",
}
"""What plain names of data look like, by what they may mean: numbers that are not color."""
_DATA = re.compile("|".join(DATA_NAMES.values()))
_MOST_LISTED = 20
_DEPTH = re.compile(r"z|_*(z_?depth|depth_?z|depth|hitpz|linear_?depth|zfiltered)", re.IGNORECASE)


class Layer(Struct, frozen=True):
    """A named group of channels of one part. `data` means numbers that are not color: never converted.

    `channels` are short names in natural order (RGBA, XYZW); `indices` are their places in the part. `full` is the
    name as the file has it, `name` the same without what all layers share (`ViewLayer.`). `format` is a numpy dtype.
    """

    name: str
    channels: tuple[str, ...]
    part: int
    indices: tuple[int, ...]
    format: str
    is_data: bool
    full_name: str

    @property
    def first(self) -> int:
        """The place of its first channel in the part."""
        return self.indices[0]

    @property
    def is_half(self) -> bool:
        """True if 16-bit floats hold it without loss."""
        return self.format == "float16"


class ChannelPart(Struct, frozen=True):
    """What the header of one part says: `tag` is its color space or "data", "" where nobody said."""

    index: int
    name: str
    channels: tuple[str, ...]
    formats: tuple[str, ...]
    tag: str

    @property
    def label(self) -> str:
        """Its name, or its number where it has none."""
        return self.name or f"part{self.index}"


def is_depth(name: str) -> bool:
    """True for the usual names of a depth layer."""
    return _DEPTH.fullmatch(name) is not None


def group_channels(parts: Sequence[ChannelPart]) -> tuple[Layer, ...]:
    """All layers in file order, each under a name of its own."""
    several = len(parts) > 1
    found = [(part, layer) for part in parts for layer in _split_part(part, several)]
    taken = Counter(layer.full_name for _, layer in found)
    found = [
        (part, layer if taken[layer.full_name] == 1 else replace(layer, full_name=f"{part.label}.{layer.full_name}"))
        for part, layer in found
    ]
    tokens = {layer.full_name.partition(".")[0] for _, layer in found}
    shared = len(tokens) == 1 and all("." in layer.full_name for _, layer in found)
    return tuple(
        _with_short_name(layer, layer.full_name.partition(".")[2] if shared else layer.full_name, part.tag)
        for part, layer in found
    )


def _with_short_name(layer: Layer, name: str, tag: str) -> Layer:
    """The layer under its short name, which also says whether it is data where the header does not."""
    words = tuple(word.casefold() for word in layer.channels)
    colored = any(set(words) <= set(family) for family in _FAMILIES[:3])
    data = (
        tag == "data"
        or not colored
        or (not tag and _DATA.fullmatch(normalize_name(name).rpartition(".")[2]) is not None)
    )
    return replace(layer, name=name, is_data=data)


def _split_part(part: ChannelPart, several: bool) -> Iterable[Layer]:
    """The layers of one part: channels grouped by prefix, bare ones by what belongs together."""
    groups: dict[str, list[int]] = {}
    bare = {name.casefold() for name in part.channels if "." not in name}
    family = next((family for family in _FAMILIES if len(bare.intersection(family)) > 1), ())
    for index, channel in enumerate(part.channels):
        prefix = channel.rpartition(".")[0]
        key = prefix + "." if prefix else "" if channel.casefold() in family else channel
        groups.setdefault(key, []).append(index)
    groups = dict(_without_strangers(part.channels, groups))
    named = several and part.name
    for key, places in groups.items():
        indices = _in_natural_order(part.channels, places)
        short = tuple(part.channels[index].rpartition(".")[2] for index in indices)
        full = key[:-1] if key.endswith(".") else key or "".join(short)
        if named and "." not in key:
            full = part.name if len(groups) == 1 or not key else f"{part.name}.{full}"
        formats = {part.formats[index] for index in indices}
        kept = formats.pop() if len(formats) == 1 else "float32"
        yield Layer("", short, part.index, indices, kept, False, full)


def _without_strangers(names: Sequence[str], groups: Mapping[str, list[int]]) -> Iterable[tuple[str, list[int]]]:
    """The groups; what stands beside the colors of one is its own, such as the depth of a view (`left.R`, `left.Z`)."""
    for key, places in groups.items():
        words = {index: names[index].rpartition(".")[2].casefold() for index in places}
        colors = next((family for family in _FAMILIES[:2] if set(family[:3]) <= set(words.values())), ())
        own = [index for index in places if words[index] in colors] if colors and key else list(places)
        yield key, own
        yield from ((names[index], [index]) for index in places if index not in own)


def _in_natural_order(names: Sequence[str], places: Sequence[int]) -> tuple[int, ...]:
    """Places in the natural order of their components, or as they are where there is none."""
    words = {index: names[index].rpartition(".")[2].casefold() for index in places}
    family = next((family for family in _FAMILIES if set(words.values()) <= set(family)), None)
    return tuple(sorted(places, key=lambda index: family.index(words[index])) if family else places)


def normalize_name(name: str) -> str:
    """A name for comparison: no case, no blanks, underscores or hyphens."""
    return re.sub(r"[\s_-]", "", name.casefold())


def match_layer(path: str, layers: Sequence[Layer], name: str) -> Layer:
    """What `info.find_layer` finds among the layers of a file, from the strictest reading of `name` to the loosest."""
    if not layers:
        raise InputError(f"{path}: holds no channels that can be read")
    if not name:
        return _default_layer(layers)
    wanted = normalize_name(name)
    tiers: tuple[Callable[[Layer], bool], ...] = (
        lambda layer: name in (layer.full_name, layer.name),
        lambda layer: wanted in (normalize_name(layer.full_name), normalize_name(layer.name)),
        lambda layer: normalize_name(layer.full_name).endswith("." + wanted),
        lambda layer: len(layer.channels) == 1 and normalize_name(layer.channels[0]) == wanted,
    )
    for tier in tiers:
        if match := [layer for layer in layers if tier(layer)]:
            return _single_match(path, name, match)
    if match := [
        one
        for layer in layers
        for one in _single_channels(layer)
        if f".{normalize_name(one.full_name)}".endswith("." + wanted)
    ]:
        return _single_match(path, name, match)
    choices = [layer.name for layer in layers]
    near = suggest_layers(layers, name)
    hint = f"did you mean '{near[0]}'? It" if near else "it"
    rest = f" and {len(choices) - _MOST_LISTED} more" if len(choices) > _MOST_LISTED else ""
    raise InputError(f"{path}: has no layer '{name}': {hint} holds {', '.join(choices[:_MOST_LISTED])}{rest}")


def suggest_layers(layers: Sequence[Layer], name: str) -> list[str]:
    """The names of layers that are most like one that is not there, at most three."""
    known = {normalize_name(layer.name): layer.name for layer in layers}
    return [known[word] for word in difflib.get_close_matches(normalize_name(name), known, 3, 0.5)]


def _default_layer(layers: Sequence[Layer]) -> Layer:
    """The picture itself: by name, else the first color layer, else the first."""
    colors = [layer for layer in layers if not layer.is_data]
    for word in _BEAUTY:
        for layer in colors:
            if normalize_name(layer.name).rpartition(".")[2] == word:
                return layer
    return (colors or layers)[0]


def _single_channels(layer: Layer) -> Iterable[Layer]:
    """Every channel of a layer as a layer of its own."""
    for channel, index in zip(layer.channels, layer.indices, strict=True):
        yield replace(
            layer,
            name=f"{layer.name}.{channel}",
            full_name=f"{layer.full_name}.{channel}",
            channels=(channel,),
            indices=(index,),
            is_data=True,
        )


def _single_match(path: str, name: str, match: Sequence[Layer]) -> Layer:
    if len(match) > 1:
        raise InputError(
            f"{path}: '{name}' may mean {' or '.join(layer.full_name for layer in match)}: write one of them"
        )
    return match[0]


def split_layer(text: str) -> tuple[str, str]:
    """`shot.exr:Depth` as path and layer. A path that exists as it stands has no layer; `C:` is a drive."""
    path, colon, layer = text.rpartition(":")
    if not colon or len(path) < 2 or "/" in layer or "\\" in layer or Path(text).exists():
        return text, ""
    return path, layer

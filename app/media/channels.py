"""Sorts the channels of a file into its layers.

A channel is `[view layer.]layer.component`; in a multi-part file the name of the part may replace the prefix. Channels
with the same prefix are a layer. Channels without a prefix belong together if their letters do (R, G, B, A); each other
one is a layer. If the header does not say whether a layer is color or data, it is data if its letters are not those of
a color, or if its name is that of data.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from msgspec import Struct
from msgspec.structs import replace

from .layers import Layer, normalize_name

_COMPONENTS = (
    ("r", "g", "b", "a"),
    ("red", "green", "blue", "alpha"),
    ("y", "a"),
    ("x", "y", "z", "w"),
    ("u", "v", "a"),
)
"""Components that belong together, in their natural order. The first three are those of color."""

_COLORS = _COMPONENTS[:3]
_RGB = _COMPONENTS[:2]

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
"""Normalized names of data layers, by what they may mean: numbers that are not color."""
_DATA = re.compile("|".join(DATA_NAMES.values()))
_DEPTH = re.compile(r"z|_*(z_?depth|depth_?z|depth|hitpz|linear_?depth|zfiltered)", re.IGNORECASE)


class ChannelPart(Struct, frozen=True):
    """The channels of one part of a file. `tag` is its color space or "data", "" if the header has none."""

    index: int
    name: str
    channels: tuple[str, ...]
    formats: tuple[str, ...]
    tag: str

    @property
    def label(self) -> str:
        """Its name, or its number without one."""
        return self.name or f"part{self.index}"


def is_depth(name: str) -> bool:
    """True for the usual names of a depth layer."""
    return _DEPTH.fullmatch(name) is not None


def group_channels(parts: Sequence[ChannelPart]) -> tuple[Layer, ...]:
    """All layers of a file in file order, each under a unique name."""
    several = len(parts) > 1
    layers = [(part, layer) for part in parts for layer in _split_part(part, several)]
    uses = Counter(layer.full_name for _, layer in layers)
    layers = [
        (part, layer if uses[layer.full_name] == 1 else replace(layer, full_name=f"{part.label}.{layer.full_name}"))
        for part, layer in layers
    ]
    prefixes = {layer.full_name.partition(".")[0] for _, layer in layers}
    has_shared_prefix = len(prefixes) == 1 and all("." in layer.full_name for _, layer in layers)
    return tuple(_finish_layer(layer, has_shared_prefix, part.tag) for part, layer in layers)


def _finish_layer(layer: Layer, has_shared_prefix: bool, tag: str) -> Layer:
    """The layer with its short name, and whether it is data: by the tag of its part, else by letters and name."""
    name = layer.full_name.partition(".")[2] if has_shared_prefix else layer.full_name
    components = {component.casefold() for component in layer.channels}
    is_color = any(components <= set(family) for family in _COLORS)
    is_named_data = _DATA.fullmatch(normalize_name(name).rpartition(".")[2]) is not None
    return replace(layer, name=name, is_data=tag == "data" or not is_color or (not tag and is_named_data))


def _split_part(part: ChannelPart, several: bool) -> Iterable[Layer]:
    """The layers of one part: channels grouped by prefix, those without a prefix by their letters."""
    groups: dict[str, list[int]] = {}
    unprefixed = {name.casefold() for name in part.channels if "." not in name}
    family = next((family for family in _COMPONENTS if len(unprefixed.intersection(family)) > 1), ())
    for index, channel in enumerate(part.channels):
        prefix = channel.rpartition(".")[0]
        key = prefix + "." if prefix else "" if channel.casefold() in family else channel
        groups.setdefault(key, []).append(index)
    groups = dict(_separate_strangers(part.channels, groups))
    takes_part_name = several and part.name
    for key, places in groups.items():
        indices = _sort_components(part.channels, places)
        components = tuple(part.channels[index].rpartition(".")[2] for index in indices)
        full_name = key[:-1] if key.endswith(".") else key or "".join(components)
        if takes_part_name and "." not in key:
            full_name = part.name if len(groups) == 1 or not key else f"{part.name}.{full_name}"
        formats = {part.formats[index] for index in indices}
        format = formats.pop() if len(formats) == 1 else "float32"
        yield Layer("", components, part.index, indices, format, False, full_name)


def _separate_strangers(names: Sequence[str], groups: Mapping[str, list[int]]) -> Iterable[tuple[str, list[int]]]:
    """The groups. Channels beside the colors of a group become groups of their own, such as the depth of a view
    (`left.R`, `left.Z`)."""
    for key, places in groups.items():
        words = {index: names[index].rpartition(".")[2].casefold() for index in places}
        colors = next((family for family in _RGB if set(family[:3]) <= set(words.values())), ())
        members = [index for index in places if words[index] in colors] if colors and key else list(places)
        yield key, members
        yield from ((names[index], [index]) for index in places if index not in members)


def _sort_components(names: Sequence[str], places: Sequence[int]) -> tuple[int, ...]:
    """The indices of channels in the natural order of their components; in file order if there is none."""
    words = {index: names[index].rpartition(".")[2].casefold() for index in places}
    family = next((family for family in _COMPONENTS if set(words.values()) <= set(family)), None)
    return tuple(sorted(places, key=lambda index: family.index(words[index])) if family else places)

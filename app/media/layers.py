"""The layers of a file, and how one is found by a name that the user writes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from halation.nodes import Size
from msgspec import Struct
from msgspec.structs import replace

from ..errors import InputError
from ..resources.picture import PixelRectangle
from ..resources.suggestions import find_near_names

_BEAUTY_NAMES = ("combined", "beauty", "rgba", "rgb", "c", "ci")
"""Names that renderers give the picture itself, the usual one first."""

_MOST_LISTED = 20
"""Layers that an error message lists. Chosen by judgement: about a line."""


class Layer(Struct, frozen=True):
    """A named group of channels of one part of a file.

    `channels` are short names in natural order (RGBA, XYZW); `indices` are their places in the part. `full_name` is
    the name as the file has it, `name` the same without what all layers share (`ViewLayer.`). `format` is a numpy
    dtype. `is_data` means numbers that are not color: they are never converted.
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
        """The index of its first channel in the part."""
        return self.indices[0]

    @property
    def is_half(self) -> bool:
        """True if 16-bit floats hold it without loss."""
        return self.format == "float16"


class ImageInfo(Struct, frozen=True):
    """The facts of a file's header that rendering needs.

    `size` is the display window, upright; `fingerprint` changes when the file does. `by_rows` is True if single rows
    can be read: pixels are stored upright, over the whole window, and not as one stream. `overscan` is the rectangle
    (x, y, width, height) of the display window, whose top left pixel is 0, and of all pixels around it; None where
    there are none. `pixel_aspect` is the width of a pixel over its height, upright.
    """

    path: str
    size: Size
    layers: tuple[Layer, ...]
    fingerprint: str
    format: str
    by_rows: bool = False
    overscan: PixelRectangle | None = None
    pixel_aspect: float = 1.0


def find_layer(info: ImageInfo, name: str, suggest: Callable[[str], list[str]] | None = None) -> Layer:
    """The layer that `name` means: `Combined`, `ViewLayer.Combined`, `Z`, or one channel such as `Position.Z`.

    Case, blanks, `_` and `-` do not matter; "" is the first color layer. Readings of the name are tried in order:
    unchanged, normalized, without its prefix, as a channel; the first that fits a layer decides. `suggest` returns
    names that the user may have meant; without it, names with a similar spelling are suggested.

    Raises:
        InputError: no layer, or more than one, answers to the name.
    """
    if not info.layers:
        raise InputError(f"{info.path}: holds no channels that can be read")
    if not name:
        return _default_layer(info.layers)
    matches = _match_name(info, name)
    if len(matches) > 1:
        names = " or ".join(layer.full_name for layer in matches)
        raise InputError(f"{info.path}: '{name}' may mean {names}: write one of them")
    if not matches:
        raise _unknown_layer(info, name, suggest(name) if suggest else suggest_layers(info.layers, name))
    return matches[0]


def has_layer(info: ImageInfo, name: str) -> bool:
    """True if at least one layer has the name."""
    return bool(_match_name(info, name))


def _match_name(info: ImageInfo, name: str) -> list[Layer]:
    """The layers that fit the strictest reading of a name."""
    word = normalize_name(name)
    readings: tuple[Callable[[Layer], bool], ...] = (
        lambda layer: name in (layer.full_name, layer.name),
        lambda layer: word in (normalize_name(layer.full_name), normalize_name(layer.name)),
        lambda layer: normalize_name(layer.full_name).endswith("." + word),
        lambda layer: len(layer.channels) == 1 and normalize_name(layer.channels[0]) == word,
    )
    matches = next((fits for reading in readings if (fits := [layer for layer in info.layers if reading(layer)])), [])
    if not matches:
        channels = [channel for layer in info.layers for channel in _single_channels(layer)]
        matches = [channel for channel in channels if f".{normalize_name(channel.full_name)}".endswith("." + word)]
    return matches


def suggest_layers(layers: Sequence[Layer], name: str) -> list[str]:
    """The names of layers that are most similar to a name, at most three."""
    names = {normalize_name(layer.name): layer.name for layer in layers}
    return [names[word] for word in find_near_names(normalize_name(name), names, 3)]


def normalize_name(name: str) -> str:
    """A name for comparison: no case, no blanks, underscores or hyphens."""
    return re.sub(r"[\s_-]", "", name.casefold())


def split_layer(text: str) -> tuple[str, str]:
    """`shot.exr:Depth` as path and layer. A path that exists has no layer; `C:` is a drive."""
    path, colon, layer = text.rpartition(":")
    if not colon or len(path) < 2 or "/" in layer or "\\" in layer or Path(text).exists():
        return text, ""
    return path, layer


def _unknown_layer(info: ImageInfo, name: str, suggestions: Sequence[str]) -> InputError:
    hint = f"did you mean '{suggestions[0]}'? It" if suggestions else "it"
    names = ", ".join(layer.name for layer in info.layers[:_MOST_LISTED])
    rest = f" and {len(info.layers) - _MOST_LISTED} more" if len(info.layers) > _MOST_LISTED else ""
    return InputError(f"{info.path}: has no layer '{name}': {hint} holds {names}{rest}")


def _default_layer(layers: Sequence[Layer]) -> Layer:
    """The layer of the picture itself: by name, else the first color layer, else the first layer."""
    colors = [layer for layer in layers if not layer.is_data]
    for word in _BEAUTY_NAMES:
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

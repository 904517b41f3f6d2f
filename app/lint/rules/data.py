"""Layers of data where color is wanted."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, cast

from halation.nodes import Kind

from ...graph import INPUTS, Port, Problem
from ...graph.rules import Rule
from ..sheet import Check, Sheet, is_one_of

if TYPE_CHECKING:
    from halation.nodes.input.read_image import ReadImage

DATA_AS_COLOR = Rule(
    "data-as-color",
    "warning",
    "A layer of data (depth, normals, motion, ids) goes into a node that is about color or light: what comes out "
    "means nothing.",
    "Link the picture; to look at data use levels or gradient_map, and read it as a Field or Vector.",
)

_COLOR = frozenset(
    {
        "auto_exposure",
        "bloom",
        "bright_pass",
        "cdl",
        "channel_mixer",
        "chroma_key",
        "color_space",
        "dither",
        "exposure",
        "eye_adaptation",
        "eye_glare",
        "film_grain",
        "film_halation",
        "ghosts",
        "hue_saturation",
        "kernel_glare",
        "local_tone_map",
        "lut_file",
        "over_exposure",
        "photoreceptor_tone_map",
        "saturation",
        "scotopic_vision",
        "split_toning",
        "star",
        "streaks",
        "tone_map",
        "white_balance",
    }
)
_DATA = re.compile(
    r"(.*[._ ])?(z|z?_?depth|position|p|normals?|n|vector|velocity|motion_?vectors?|motion|uvs?|st"
    r"|(object|material)_?(id|index)|index(ob|ma)|crypto.*)(\.[a-z]+)?",
    re.IGNORECASE,
)
"""Names of layers that are never color, such as `Depth`, `ViewLayer.Normal` and `CryptoObject00`."""
_OUTPUTS = frozenset({"depth", "normal", "position", "velocity", "object_id", "material_id", "uv"})


def find(sheet: Sheet) -> Iterator[Problem]:
    """Nodes of color right behind a layer of data."""
    for id in sheet.graph.nodes:
        item = sheet.works(id)
        if is_one_of(item, _COLOR) and (source := sheet.first(id)) and (what := _data(sheet, source)):
            name = next(iter(item.inputs))
            sentence = f"'{id}' is about color, and '{source}' is data ({what}): link a picture to '{id}.{name}'"
            yield Problem(id, name, sentence, DATA_AS_COLOR, f"links.{id}.{name}")


def _data(sheet: Sheet, source: Port) -> str:
    """What data leaves at a port, or nothing for what may be color."""
    if source.node == INPUTS:
        end = sheet.graph.inputs[source.socket]
        layer = end.layer if end.layer or end.kind is Kind.IMAGE else source.socket
    else:
        item = sheet.graph.nodes[source.node]
        if is_one_of(item, {"read_render"}):
            return source.socket if source.socket in _OUTPUTS else ""
        layer = cast("ReadImage", item).layer if is_one_of(item, {"read_image"}) else ""
    return layer if _DATA.fullmatch(layer) else ""


CHECKS = (Check(DATA_AS_COLOR, find),)

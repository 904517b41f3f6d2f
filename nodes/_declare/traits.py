"""Traits: what a node tells the rules of `halation check` and the tests of all nodes."""

from __future__ import annotations

from enum import StrEnum
from typing import Literal

from msgspec import Struct


class Trait(StrEnum):
    """A property of a node that its sockets and values do not show. *The picture* is its first input.

    A node lists its own: `traits = (Trait.NEEDS_COLOR,)`.
    """

    NEEDS_COLOR = "needs color"
    """The picture is color or light: a layer of data, such as depth or normals, makes no sense there."""
    NEEDS_SCENE_LIGHT = "needs scene light"
    """It calculates with scene-linear light, so that it belongs before the tone map."""
    NEEDS_HIGHLIGHTS = "needs highlights"
    """It makes light glow or spread. It needs light brighter than white, so that a file of 8 bits is a poor input."""
    NEEDS_SURFACES = "needs surfaces"
    """Its picture stays black where none of its inputs `depth`, `normal`, `position` and `ids` has a link."""
    MAKES_DISPLAY_LIGHT = "makes display light"
    """Its first output is ready for the display, as after a tone map."""
    CHANGES_ENCODING = "changes encoding"
    """It converts color. Its values decide whether scene light or display light comes out."""
    RESAMPLES = "resamples"
    """It filters the picture: two such nodes in a row cost sharpness and time."""
    WARPS = "warps"
    """It shows pixels of the picture at other places, so that with overscan the result goes on beyond the frame."""
    STRETCHES = "stretches"
    """It shows all of the picture in another number of pixels, whose shape is another one where the sides differ."""
    CUTS_OUT = "cuts out"
    """Its result is a part of the picture, in pixels of the same size. Lengths after it follow the whole picture."""
    KEEPS_NON_FINITE = "keeps non-finite"
    """It passes NaN and infinity on. All other nodes make every pixel finite, with `lib/finite.glsl`."""
    USES_ALPHA = "uses alpha"
    """Its color depends on alpha. All other pointwise nodes treat a half-covered pixel as half of the same pixel fully
    covered, with `lib/alpha.glsl`."""


class ProxyNote(Struct, frozen=True):
    """Why outputs of a proxy, rendered at half the size, do not look like the full picture made smaller."""

    outputs: tuple[str, ...]
    reason: str
    differs: Literal["detail", "look"] = "detail"
    """Whether they differ in fine detail only, or in the whole look."""

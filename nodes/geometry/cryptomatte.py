import csv
import struct
from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Field, FilePath, Image, Matte, Output, Source, Vector

_AT_ONCE = 32
"""Ids that one draw looks for: two to a vector."""


class Cryptomatte(Source):
    """Cut out objects, materials or assets by name, with the soft edges and the blur that the render has.

    Reads the cryptomatte layers of a render (Friedman and Jones 2015, by Psyop's specification 1.2.0): the matte is the
    sum of what every id that was picked covers, exactly. Names are looked up in the file's manifest, else hashed.
    """

    path: Annotated[FilePath, Doc("The render, relative to the graph's folder.")] = ""
    layer: Annotated[Literal["object", "material", "asset"], Doc("What is told apart.")] = "object"
    pick: Annotated[str, Doc(
        "Names, such as monkey, ring_*, \"with, comma\". In a name, * is any text, ? any letter, [ab] one of these. "
        "What follows after a minus is left out: *, -floor."
    )] = "*"
    invert: Annotated[bool, Doc("Everything else.")] = False

    matte = Output(Field(doc="How much of each pixel is covered by what was picked, 0..1."))
    colors = Output(Image(doc="A color for every id, to see which is where."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        matte = self._chosen(draw.render(self.path).mattes)
        if matte is None:
            return {}
        ranks = [draw.read(self.path, layer, Vector(width=4)) for layer in matte.layers]
        ids = sorted(_picked(self.pick, matte.ids))
        found = draw.point("cryptomatte_nothing", result=Field())
        if not matte.ids and self.pick.strip() == "*":
            for layer in ranks:
                found = draw.point("cryptomatte_anything", result=Field(), found=found, ranks=layer)
        for first in range(0, len(ids), _AT_ONCE):
            some = ids[first : first + _AT_ONCE]
            # Halves of the bits: floats hold them exactly, and no driver takes them for a number that it may change.
            halves = [float(half) for bits in some for half in (bits >> 16, bits & 0xFFFF)]
            halves += [0.0] * (2 * _AT_ONCE - len(halves))
            for layer in ranks:
                found = draw.point(
                    "cryptomatte_covered", result=Field(), found=found, ranks=layer, ids=tuple(halves), count=len(some)
                )
        colors = draw.point("cryptomatte_no_colors", result=Vector(width=4))
        for layer in ranks:
            colors = draw.point("cryptomatte_mixed", result=Vector(width=4), colors=colors, ranks=layer)
        return {
            "matte": draw.point("cryptomatte", result=Field(), found=found, invert=self.invert),
            "colors": draw.point("cryptomatte_colors", colors=colors),
        }

    def _chosen(self, mattes: tuple[Matte, ...]) -> Matte | None:
        """The one that tells apart what is wanted, or the only one that does not say what it tells apart."""
        plain = [matte for matte in mattes if not matte.kind]
        return next((matte for matte in mattes if matte.kind == self.layer), plain[0] if len(plain) == 1 else None)


def _picked(pick: str, manifest: Mapping[str, int]) -> set[int]:
    """The ids that a list of names stands for."""
    found: set[int] = set()
    for name in next(csv.reader([pick.replace("\n", ",")], skipinitialspace=True), list[str]()):
        name = name.strip()
        leaves_out = name.startswith("-") and name not in manifest
        ids = set(_ids(name[1:].strip() if leaves_out else name, manifest))
        found = found - ids if leaves_out else found | ids
    return found


def _ids(name: str, manifest: Mapping[str, int]) -> Iterator[int]:
    if name in manifest:
        yield float_bits(manifest[name])
    elif any(letter in name for letter in "*?["):
        yield from (float_bits(bits) for other, bits in manifest.items() if fnmatchcase(other, name))
    elif name:
        yield float_bits(murmur3(name.encode()))


def murmur3(data: bytes) -> int:
    """MurmurHash3_x86_32 with seed 0 (Appleby 2011, public domain)."""
    whole = len(data) // 4 * 4
    result = 0
    for (word,) in struct.iter_unpack("<I", data[:whole]):
        result = (_rotated(result ^ _scrambled(word), 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    result ^= _scrambled(int.from_bytes(data[whole:], "little")) ^ len(data)
    result = ((result ^ result >> 16) * 0x85EBCA6B) & 0xFFFFFFFF
    result = ((result ^ result >> 13) * 0xC2B2AE35) & 0xFFFFFFFF
    return result ^ result >> 16


def _scrambled(word: int) -> int:
    return _rotated(word * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF


def _rotated(word: int, count: int) -> int:
    return (word << count | word >> 32 - count) & 0xFFFFFFFF


def float_bits(number: int) -> int:
    """A hash as the bits of a float that is a usual number: no zero, denormal, infinity or NaN."""
    exponent = number >> 23 & 0xFF
    return number ^ 1 << 23 if exponent in (0, 0xFF) else number

"""What an effect consists of while it is written: textures, functions, and the passes that call them."""

from __future__ import annotations

import numpy as np
from msgspec import Struct, field

from ...errors import GraphError, describe_owner
from ..package import Package
from ..package.curves import Record
from .numbers import Array, NumberPicture
from .pictures import PackedPictures
from .programs import write_table

_SAMPLER = "sampler2D {0}Sampler {{ Texture = {0}; MinFilter = POINT; MagFilter = POINT; MipFilter = POINT; }};"
_FORMATS = ("R32F", "RG32F", "RGBA32F", "HALATION_COLORS")
"""Formats by the number of channels."""


class EffectPass(Struct, frozen=True):
    """A pass of the technique: a function, and the textures that it draws into; none for the screen."""

    function: str
    targets: tuple[str, ...] = ()


class EffectParts(Struct):
    """The parts of an effect so far, in order."""

    package: Package
    numbers: NumberPicture
    pictures: PackedPictures
    textures: dict[str, str] = field(default_factory=dict[str, str])
    """The declaration of each texture by its name."""
    passes: list[EffectPass] = field(default_factory=list[EffectPass])
    lines: list[str] = field(default_factory=list[str])
    tables: dict[str, str] = field(default_factory=dict[str, str])
    """The function that samples each table of a color library, by the name of its sampler."""

    def add_texture(self, name: str, surface: Record) -> str:
        """The name of a texture of the size and format of a surface; surfaces of one slot may differ in both."""
        width, height = surface["size"]
        size = f"Width = {width}; Height = {height}; Format = {_FORMATS[len(surface['format']) - 4]};"
        text = f"texture2D {name} {{ {size} }};\n{_SAMPLER.format(name)}"
        if self.textures.setdefault(name, text) != text:
            return self.add_texture(f"{name}x", surface)
        return name

    def add_pass(self, function: str, *targets: str) -> None:
        """Add a pass that draws into textures, or to the screen."""
        self.passes.append(EffectPass(function, targets))

    def add_drawing(self, name: str, value: str) -> None:
        """Add a pass that fills a texture with an expression of the place of a pixel."""
        self.lines.append(
            f"float4 fill_{name}(float4 position : SV_Position) : SV_Target "
            f"{{ int2 place = int2(position.xy); return {value}; }}"
        )
        self.add_pass(f"fill_{name}", name)

    def fill_surface(self, surface: Record, name: str, roles: dict[int, str]) -> None:
        """Fill a surface that no pass draws: with what the game gives, a picture, or numbers."""
        if any(each.targets == (name,) for each in self.passes):
            return
        channels = len(surface["format"]) - 3
        if "source" in surface and surface["source"] in roles:
            self.add_pass(f"draw_{roles[surface['source']]}", name)
        elif "source" in surface:
            source = self.package.document["sources"][surface["source"]]
            kind = np.float16 if source["format"].endswith("16f") else np.float32
            width, height = source["size"]
            pixels = np.frombuffer(self.package.blobs[source["blob"]], kind).reshape(height, width, -1)
            self._fill_stored(name, pixels, source["name"])
        elif "numbers" in surface:
            known = self.numbers.find_numbers(surface["numbers"])
            height, width, depth = (round(number) for number in known[:3])
            if self.numbers.changes(surface["numbers"]):
                self._fill_list(name, surface["numbers"], (width, depth), channels)
                return
            pixels = np.zeros((height, width, channels), np.float32)
            pixels[..., :depth] = known[3 : 3 + height * width * depth].reshape(height, width, depth)
            self._fill_stored(name, pixels, "")

    def add_table(self, record: Record) -> None:
        """Add a table of a color library, once."""
        if record["sampler"] not in self.tables:
            values = np.frombuffer(self.package.blobs[record["blob"]], np.float32).reshape(record["shape"])
            name, lines = write_table(record, values, self.pictures, len(self.tables))
            self.tables[record["sampler"]] = name
            self.lines += lines
            self.add_pass(f"draw_{name}", name.replace("table_", "Table"))

    def _fill_stored(self, name: str, pixels: Array, owner: str) -> None:
        try:
            stored = self.pictures.add(pixels)
        except ValueError as error:
            raise GraphError(f"{describe_owner(owner)} {error}: export it smaller with --size", node=owner) from None
        self.add_drawing(name, f"{stored}(place)")

    def _fill_list(self, name: str, slot: int, size: tuple[int, int], channels: int) -> None:
        """Numbers that controls change, from the picture of numbers; the first three are height, width and channels."""
        width, depth = size
        first = self.numbers.add_slot(slot, 4)
        start = f"3 + (place.y * {width} + place.x) * {depth}"
        parts = [f"{name}_at({start} + {at})" if at < min(depth, channels) else "0.0" for at in range(4)]
        self.lines.append(f"float {name}_at(int at) {{ return number({first} + at / 4)[at % 4]; }}")
        self.add_drawing(name, f"float4({', '.join(parts)})")

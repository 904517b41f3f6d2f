"""What shaders know of the color space that they work in."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from ..glsl import GlslText, parse

_NAME = "lib/working"
_TEXT = """
const vec3 LUMINANCE_WEIGHTS = vec3({luminance});
vec3 to_rec709(vec3 rgb) {{ return rgb * mat3({to}); }}
vec3 from_rec709(vec3 rgb) {{ return rgb * mat3({back}); }}
"""


class WorkingSpace(Struct, frozen=True):
    """A working space: the luminance of its red, green and blue, and matrices, by rows, that take its colors to linear
    Rec.709 and back."""

    luminance: tuple[float, ...]
    to_rec709: tuple[float, ...]
    from_rec709: tuple[float, ...]

    @property
    def text(self) -> GlslText:
        """The file of the library that says so."""
        parts = {"luminance": self.luminance, "to": self.to_rec709, "back": self.from_rec709}
        return parse(_NAME, _TEXT.format(**{name: _numbers(numbers) for name, numbers in parts.items()}))


def _numbers(numbers: Sequence[float]) -> str:
    return ", ".join(f"{number:.9f}" for number in numbers)

from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Draw, Drawn, Field, Filter, Image, OutputSocket, Slider


class PixelFormula(Filter):
    """Compute every pixel by a formula, such as `a * (1 - b.a) + b`, in the language of expressions.

    `a` to `d` are the pixels of the inputs, with the channels r, g, b, a; `p` to `s` are numbers. `x` and `y` are the
    place of the pixel from the top left, `u` and `v` the same from 0 to 1, `width` and `height` the size; also `frame`,
    `time` and `rate`. A number gives an opaque gray, `[r, g, b]` an opaque color, `[r, g, b, a]` a premultiplied one.
    What has no value, such as a division by 0, is 0.
    """

    aliases = (
        "expression", "merge expression", "pixel expression", "formula", "math expression", "custom math", "shader",
        "channel math", "custom tool", "per pixel", "calculate", "code", "se expr",
    )  # fmt: skip

    a = Image(0.0)
    b = Image(0.0)
    c = Image(0.0)
    d = Image(0.0)
    formula: Annotated[str, Doc("The formula.")] = "a"
    p: Annotated[float, Slider(0.0, 1.0, unit="ratio", doc="A number for the formula.")] = 0.0
    q: Annotated[float, Slider(0.0, 1.0, unit="ratio", doc="A second number for the formula.")] = 0.0
    r: Annotated[float, Slider(0.0, 1.0, unit="ratio", doc="A third number for the formula.")] = 0.0
    s: Annotated[float, Slider(0.0, 1.0, unit="ratio", doc="A fourth number for the formula.")] = 0.0

    out = OutputSocket(Image(doc="The result as a picture."))
    value = OutputSocket(Field(doc="The result of a formula that makes a number; else its first channel."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        names = {"a": self.a, "b": self.b, "c": self.c, "d": self.d, "p": self.p, "q": self.q, "r": self.r, "s": self.s}
        color = draw.formula(self.formula, **names)
        return {
            "out": draw.point("pixel_formula", color=color),
            "value": draw.point("pixel_formula_value", color=color, result=Field()),
        }

from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Field, Fraction, Image, Pointwise, Size, Slider

Mode = Literal[
    "over",
    "under",
    "in",
    "out",
    "atop",
    "xor",
    "clear",
    "plus",
    "multiply",
    "screen",
    "overlay",
    "soft light",
    "hard light",
    "color dodge",
    "color burn",
    "darken",
    "lighten",
    "difference",
    "exclusion",
    "subtract",
    "divide",
    "hypot",
    "average",
    "hue",
    "saturation",
    "color",
    "luminosity",
]


class Merge(Pointwise):
    """Combine the foreground `a` with the background `b`. The result has the size of `b`.

    The modes from over to plus are the operators of Porter and Duff (1984). The others blend the colors where both
    pictures cover, by the W3C's Compositing and Blending Level 1: `a (1 - b.alpha) + b (1 - a.alpha) + a.alpha b.alpha
    blend(b, a)`. Within 0..1 they are the formulas of the W3C, which define no brighter light; for that the formulas
    are continued without a jump, as the comments in the shader say.
    """

    aliases = (
        "over", "composite", "alpha over", "blend", "layer", "mix", "comp", "a over b", "blend mode", "blending mode",
        "layers", "channel merge", "transfer mode", "set matte", "z combine", "zmerge", "mix color", "apply mode",
        "alpha matte", "track matte", "solid composite", "screen", "clipping mask", "preserve transparency",
        "psd merge", "multi merge",
    )  # fmt: skip

    a = Image(doc="The foreground.")
    b = Image(doc="The background.")
    mask = Field(1.0, doc="Where the result is visible; elsewhere the background stays.")
    mode: Annotated[
        Mode,
        Doc(
            "Over covers, plus adds light. Subtract is b - a, divide is b / a. Hue, saturation, "
            "color and luminosity come from the foreground, and the rest from the background."
        ),
    ] = "over"
    amount: Annotated[
        Fraction, Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="Mix of the background and the result.")
    ] = 1.0
    clipped: Annotated[
        bool, Doc("Show the foreground only on the background, whose alpha stays: a texture on a cut-out subject.")
    ] = False

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        return inputs.get("b") or super().output_size(inputs, canvas)

    def identity(self) -> str | None:
        return "b" if self.amount == 0.0 else None

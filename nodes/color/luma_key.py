from typing import Annotated, Literal

from .._declare import Doc, Field, Image, OutputSocket, Pointwise, Slider


class LumaKey(Pointwise):
    """Cut a picture out by its brightness: what lies between two levels stays.

    The matte is 1 between low and high. Beyond them it falls to 0 over the softness, linearly in light. `out` is the
    picture times the matte, `matte` is the matte times alpha. Brightness is that of the color without its alpha.
    """

    aliases = (
        "luminance key", "luma keyer", "keyer", "brightness key", "threshold", "extract", "luminance keyer",
        "luma matte", "cc threshold", "binary alpha", "ranges mask",
    )  # fmt: skip

    image = Image()
    measure: Annotated[
        Literal["luminance", "maximum", "minimum", "saturation"],
        Doc(
            "Luminance is Rec.709. Maximum and minimum are of the three channels; saturation is 1 - minimum / maximum."
        ),
    ] = "luminance"
    low: Annotated[float, Slider(0.0, 4.0, unit="scene", doc="What is darker is cut away.")] = 0.5
    high: Annotated[float, Slider(0.0, 65504.0, unit="scene", doc="What is brighter is cut away.")] = 65504.0
    low_softness: Annotated[
        float, Slider(0.0, 2.0, unit="scene", minimum=0.0, doc="Below low, the matte fades over this much light.")
    ] = 0.25
    high_softness: Annotated[
        float, Slider(0.0, 2.0, unit="scene", minimum=0.0, doc="Above high, the matte fades over this much light.")
    ] = 0.0
    invert: Annotated[bool, Doc("Cut away what would stay.")] = False

    out = OutputSocket(Image(doc="What stays."))
    matte = OutputSocket(Field(doc="How much of each pixel stays, 0..1."))

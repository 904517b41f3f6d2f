from typing import Annotated, Literal

from .._declare import Doc, Field, Image, OutputSocket, Pointwise, Slider, Trait


class DifferenceKey(Pointwise):
    """Cut out what is different from a clean plate: a picture of the same place without the subject.

    The camera must not move between both. `out` is the subject, `matte` is how different it is.
    """

    aliases = (
        "difference key", "difference matte", "difference keyer", "difference", "clean plate key", "background key",
        "remove background", "change detection",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.USES_ALPHA)

    image = Image()
    clean_plate = Image(doc="The place without the subject.")
    measure: Annotated[
        Literal["average", "largest", "distance"],
        Doc("How the differences of the three channels become one. Distance: the root of the sum of their squares."),
    ] = "average"
    tolerance: Annotated[
        float, Slider(0.0, 0.5, unit="scene", minimum=0.0, doc="Differences up to this are 0, such as noise.")
    ] = 0.05
    falloff: Annotated[
        float, Slider(0.0, 0.5, unit="scene", minimum=0.0, doc="How much more difference makes the subject solid.")
    ] = 0.1

    out = OutputSocket(Image(doc="The subject, premultiplied."))
    matte = OutputSocket(Field(doc="How different each pixel is, 0..1."))

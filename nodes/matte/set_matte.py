from typing import Annotated, Literal

from .._declare import Doc, Field, Image, Pointwise, Trait


class SetMatte(Pointwise):
    """Give a picture another matte: replace its alpha, or join it with the matte.

    The color stays the same where it is seen, so it is premultiplied with the new alpha. A pixel that had no alpha has
    no color to show; choose a straight picture for one whose color goes on outside of its alpha.
    """

    aliases = (
        "set alpha", "copy alpha", "shuffle copy", "track matte", "matte control", "add alpha", "stencil", "hold out",
        "copy matte", "set matte", "bitmap mask",
    )  # fmt: skip
    traits = (Trait.USES_ALPHA,)

    image = Image()
    matte = Field(doc="The new alpha, 0..1.")
    operation: Annotated[
        Literal["replace", "multiply", "maximum", "subtract"],
        Doc(
            "Replace: the matte. Multiply: alpha times the matte. Maximum: the larger one. Subtract: alpha without the "
            "matte, a (1 - m)."
        ),
    ] = "replace"
    color: Annotated[
        Literal["premultiplied", "straight"],
        Doc("What the color of the picture is. Straight color is only multiplied by the new alpha."),
    ] = "premultiplied"
    invert: Annotated[bool, Doc("Use 1 - matte.")] = False

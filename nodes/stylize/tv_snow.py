from typing import Annotated, Literal

from .._declare import Doc, Fraction, Image, Pointwise, Slider


class TvSnow(Pointwise):
    """Add snow to the picture, as on a television set without a signal.

    Every scan line is white noise, filtered by 1/4, 1/2, 1/4 along the line, because the band of a television channel
    is limited along lines and not across them. Hash: pcg3d (Jarzynski and Olano, 2020). Snow is part of the signal, so
    that it is mixed with sRGB values and not with light. Works on the color without its alpha; alpha stays.
    """

    aliases = (
        "static", "tv static", "noise", "white noise", "no signal", "tv", "tv noise", "interference", "analog noise",
    )  # fmt: skip

    image = Image()
    amount: Annotated[Fraction, Doc("How much of the picture is lost; 1 leaves nothing but snow.")] = 0.35
    mode: Annotated[
        Literal["mix", "multiply"],
        Doc("Mix lays snow over the picture, black parts too; multiply makes the picture itself flicker."),
    ] = "mix"
    size: Annotated[
        float, Slider(1.0, 16.0, unit="px", minimum=0.01, doc="Height of a scan line and width of a flake.")
    ] = 2.0
    contrast: Annotated[
        float,
        Slider(
            0.0,
            4.0,
            unit="ratio",
            minimum=0.0,
            maximum=64.0,
            doc="1 keeps the range of the noise. Above 1 snow is harsher, and values beyond black and"
            " white are clipped.",
        ),
    ] = 1.6
    lines: Annotated[Fraction, Doc("How much the brightness of whole lines varies.")] = 0.3
    color: Annotated[Fraction, Doc("0 is gray, as on sets with a color killer; 1 has the strongest colors.")] = 0.0
    interlaced: Annotated[
        bool, Doc("Only every second line is new in a frame, even and odd ones in turn: for frames that are fields.")
    ] = False
    hold: Annotated[int, Slider(1, 24, unit="count", minimum=1, doc="For how many frames snow stays the same.")] = 1
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another snow.")] = 0

    def identity(self) -> str | None:
        return "image" if self.amount == 0.0 else None

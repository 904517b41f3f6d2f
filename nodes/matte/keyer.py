from collections.abc import Mapping
from typing import Annotated

from .._declare import (
    RGBA,
    Doc,
    Draw,
    Drawn,
    Field,
    Filter,
    Fraction,
    Image,
    OutputSocket,
    Pixels,
    ProxyNote,
    Slider,
    Trait,
)
from ._morphology import grow


class Keyer(Filter):
    """Cut out a subject in front of a green or blue screen, with the corrections that real footage needs.

    How far the channel of the screen exceeds the others, relative to the screen at that pixel, is how much of the
    screen is seen: the color difference (Vlahos 1964). The matte is cut off below black and above white, made smaller
    and softer, and joined with the core and garbage mattes. Then the screen is subtracted, and its spill removed. `out`
    is the subject, `matte` is its coverage.
    """

    aliases = (
        "keyer", "keying", "keylight", "primatte", "ultimatte", "ibk", "ibk gizmo", "delta keyer", "chroma keyer",
        "ultra keyer", "color difference key", "green screen", "blue screen", "greenscreen", "bluescreen", "key",
        "remove background", "image based keyer", "pull key", "pik", "colour difference key", "inner outer key",
        "key cleaner",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.USES_ALPHA)

    proxy_notes = (ProxyNote(("out", "matte"), "it cuts the matte of single pixels off, and a proxy averages noise"),)

    image = Image()
    clean_plate = Image(0.0, doc="The screen alone. Without a link the screen is of one color everywhere.")
    core = Field(0.0, doc="What is solid, 0..1, whatever its color.")
    garbage = Field(0.0, doc="What is removed, 0..1, whatever its color.")
    screen: Annotated[RGBA, Doc("The color of the empty screen, as it is lit.")] = (0.06, 0.5, 0.1, 1.0)
    balance: Annotated[
        Fraction,
        Doc("What limits the screen's channel in the subject: 0 is the smaller of the other two, 1 the larger."),
    ] = 0.5
    black: Annotated[
        float,
        Slider(0.0, 1.0, unit="ratio", minimum=-1.0, maximum=1.0, doc="Mattes below this become 0: clean screen."),
    ] = 0.0
    white: Annotated[
        float,
        Slider(
            0.0,
            2.0,
            unit="ratio",
            minimum=-1.0,
            maximum=8.0,
            doc="Mattes above this become 1: solid subject. Raise it above 1 if edges of colors opposite to the screen "
            "get too solid.",
        ),
    ] = 1.0
    shrink: Annotated[
        float,
        Slider(-10.0, 10.0, unit="px", minimum=-200.0, maximum=200.0, doc="Makes the matte smaller; below 0 larger."),
    ] = 0.0
    soften: Annotated[
        float,
        Slider(0.0, 10.0, unit="px", minimum=0.0, maximum=500.0, doc="Standard deviation of the blur of the matte."),
    ] = 0.0
    spill: Annotated[
        Fraction,
        Slider(0.0, 1.0, unit="ratio", minimum=0.0, maximum=1.0, doc="How much of the screen's light is removed."),
    ] = 1.0
    spill_balance: Annotated[
        Fraction, Doc("What limits the screen's channel in the result, as `balance`; 0.5 is the average.")
    ] = 0.5

    out = OutputSocket(Image(doc="The subject, premultiplied."))
    matte = OutputSocket(Field(doc="How much of each pixel the subject covers, 0..1."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        plate = self.clean_plate if draw.is_linked(self.clean_plate) else self.screen
        raw: Pixels = draw.point(
            "keyer_matte", self.image, plate=plate, screen=self.screen, balance=self.balance, black=self.black,
            white=self.white, result=Field(),
        )  # fmt: skip
        if self.shrink != 0.0:
            wide = draw.point("keyer_wide", matte=raw)
            shrunk = grow(draw, wide, -self.shrink, "circle", "clamp")
            raw = draw.point("keyer_narrow", wide=shrunk, result=Field())
        soft = draw.blur(raw, self.soften) if self.soften > 0.0 else raw
        cover = draw.point("keyer_join", self.core, self.garbage, cover=soft, result=Field())
        out = draw.point(
            "keyer", self.image, cover=cover, plate=plate, screen=self.screen, spill=self.spill,
            spill_balance=self.spill_balance,
        )  # fmt: skip
        return {"out": out, "matte": draw.point("keyer_coverage", self.image, cover=cover, result=Field())}

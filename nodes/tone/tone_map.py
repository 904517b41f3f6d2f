"""Tone."""

from typing import Annotated, Literal

from .._declare import Doc, Image, Pointwise, Slider, Trait


class ToneMap(Pointwise):
    """Compress scene light to what a display can show.

    The result is display-linear light, 0..1: encode it as plain sRGB (view `none`), not by another view transform.
    Works on the color without its alpha. The Reinhard operators, exponential, logarithmic and Drago map luminance and
    keep the ratios of the color channels. They need the scene's luminances: link `average` and `maximum` to Luminance
    Statistics, or leave the defaults for a scene with a middle gray of 0.18. The others map each channel, for that
    gray.

    Sources: Reinhard et al. 2002; Drago et al. 2003; Krawczyk et al. 2005 (auto key); John Hable 2010 (Uncharted 2);
    ACES fits by Stephen Hill 2015 and Krzysztof Narkowicz 2015; Timothy Lottes 2016; Hajime Uchimura 2017 (Gran
    Turismo); AgX by Troy Sobotka, Rec.2020 version by Eary Chow; Khronos PBR Neutral 2024.
    """

    aliases = (
        "tonemap", "filmic", "aces", "agx", "hdr to ldr", "tone mapping", "view transform", "reinhard", "compress",
        "soft clip", "hdr", "film curve", "hdr highlight compression", "hdr compander", "toe", "hable", "tonemapping",
        "highlight rolloff", "roll-off", "print film",
    )  # fmt: skip
    traits = (Trait.NEEDS_COLOR, Trait.NEEDS_SCENE_LIGHT, Trait.MAKES_DISPLAY_LIGHT)

    image = Image()
    operator: Annotated[
        Literal[
            "reinhard",
            "reinhard extended",
            "reinhard unsquared",
            "exponential",
            "logarithmic",
            "drago",
            "aces",
            "aces narkowicz",
            "agx",
            "khronos neutral",
            "hable",
            "uchimura",
            "lottes",
        ],
        Doc(
            "Reinhard never reaches white. Extended reaches it at the maximum. Unsquared, the "
            "form without the square of the white, goes beyond white. Exponential responds like "
            "film. Logarithmic and Drago hold very high ranges. ACES has much contrast, "
            "Narkowicz's short fit of it even more. AgX keeps strong lights natural, Neutral "
            "keeps product colors, Hable is filmic. Uchimura keeps midtones as they are. Lottes "
            "is filmic with a white of its own."
        ),
    ] = "agx"
    exposure: Annotated[float, Slider(-6.0, 6.0, unit="EV", doc="Brightens the picture before it is mapped.")] = 0.0
    key: Annotated[
        float,
        Slider(
            0.045,
            0.72,
            unit="scene",
            minimum=0.0,
            doc="Reinhard, exponential: the luminance that the average becomes, low for night, high for snow.",
        ),
    ] = 0.18
    auto_key: Annotated[
        bool,
        Doc("Reinhard, exponential: let the average decide the key, 1.03 - 2 / (2 + log10(1 + average in cd/m2))."),
    ] = False
    nits: Annotated[
        float,
        Slider(0.01, 1000.0, unit="ratio", minimum=0.0, doc="For auto key: cd/m2 of a luminance of 1 in the scene."),
    ] = 100.0
    average: Annotated[
        float,
        Slider(
            0.001,
            10.0,
            unit="scene",
            minimum=0.0,
            doc="Log-average luminance of the scene (Reinhard, exponential, Drago).",
        ),
    ] = 0.18
    maximum: Annotated[
        float,
        Slider(
            1.0,
            100.0,
            unit="scene",
            minimum=0.0,
            doc="The luminance that becomes white (Reinhard extended and unsquared, logarithmic, Drago, Lottes).",
        ),
    ] = 16.0
    bias: Annotated[
        float,
        Slider(
            0.5,
            1.0,
            unit="ratio",
            minimum=0.1,
            maximum=1.0,
            doc="Drago: lower opens the shadows, higher gives contrast.",
        ),
    ] = 0.85
    q: Annotated[
        float,
        Slider(
            0.1,
            10.0,
            unit="ratio",
            minimum=1e-3,
            maximum=1e6,
            doc="Logarithmic: q in log(1 + q L) / log(1 + k maximum), for a luminance L. Higher is brighter.",
        ),
    ] = 1.0
    k: Annotated[
        float,
        Slider(
            0.1,
            10.0,
            unit="ratio",
            minimum=1e-3,
            maximum=1e6,
            doc="Logarithmic: k in that formula. Above q the picture is darker, below q brighter.",
        ),
    ] = 1.0
    contrast: Annotated[
        float,
        Slider(0.5, 1.5, unit="ratio", minimum=0.25, maximum=3.0, doc="Uchimura, Lottes: contrast of the midtones."),
    ] = 1.0
    saturation: Annotated[
        float,
        Slider(
            0.0,
            1.5,
            unit="ratio",
            minimum=0.0,
            maximum=4.0,
            doc="Reinhard, exponential, logarithmic, Drago: power of the channel ratios; 0 is gray, 1 keeps them.",
        ),
    ] = 1.0
    clip: Annotated[bool, Doc("Limit the result to 0..1. Off keeps the light of strong colors beyond that.")] = True

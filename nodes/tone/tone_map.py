from typing import Annotated, Literal

from .._declare import Doc, Image, Pointwise, Slider


class ToneMap(Pointwise):
    """Compress scene light to what a display can show.

    Out comes display-linear light, 0..1: encode it as plain sRGB (view `none`), not through another view transform.
    Works on the color without its alpha. Reinhard, logarithmic and Drago map luminance and keep the color's channel
    ratios; they need the scene's luminances: link `average` and `maximum` to Luminance Statistics, or leave the
    defaults for a scene whose middle gray is 0.18. ACES, AgX, Neutral and Hable map channels and take none of them.

    Sources: Reinhard et al. 2002; Drago et al. 2003; ACES fit by Stephen Hill 2015; AgX by Troy Sobotka, Rec.2020
    version by Eary Chow; Khronos PBR Neutral 2024; John Hable 2010 (Uncharted 2).
    """

    image = Image()
    operator: Annotated[
        Literal[
            "reinhard", "reinhard extended", "logarithmic", "drago", "aces", "agx", "khronos neutral", "hable",
        ],
        Doc(
            "Reinhard never reaches white; extended does at the maximum. Logarithmic and Drago hold very high ranges. "
            "ACES is contrasty, AgX keeps strong lights natural, Neutral keeps product colors, Hable is filmic."
        ),
    ] = "agx"
    exposure: Annotated[float, Slider(-6.0, 6.0, unit="EV", doc="Brightens the picture before it is mapped.")] = 0.0
    key: Annotated[float, Slider(
        0.045, 0.72, unit="scene", minimum=0.0, doc="Reinhard: what the average becomes, low for night, high for snow."
    )] = 0.18
    average: Annotated[float, Slider(
        0.001, 10.0, unit="scene", minimum=0.0, doc="Log-average luminance of the scene (Reinhard, Drago)."
    )] = 0.18
    maximum: Annotated[float, Slider(
        1.0, 100.0, unit="scene", minimum=0.0,
        doc="The luminance that becomes white (Reinhard extended, logarithmic, Drago)."
    )] = 16.0
    bias: Annotated[float, Slider(
        0.5, 1.0, unit="ratio", minimum=0.1, maximum=1.0, doc="Drago: lower opens the shadows, higher gives contrast."
    )] = 0.85
    saturation: Annotated[float, Slider(
        0.0, 1.5, unit="ratio", minimum=0.0, maximum=4.0,
        doc="Reinhard, logarithmic, Drago: power of the channel ratios; 0 is gray, 1 keeps them."
    )] = 1.0
    clip: Annotated[bool, Doc("Limit the result to 0..1. Off keeps what strong colors have beyond.")] = True

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Field, Filter, Image, OutputSocket, ProxyNote, Slider, Vector


class DifferenceOfGaussians(Filter):
    """Draw the picture in ink, or find its fine detail: the difference of two blurs of its tone.

    XDoG (Winnemöller et al. 2012): `S = (1 + p) G(sigma) - p G(ratio sigma)`. The result is white where S is at least
    epsilon, else `1 + tanh(phi (S - epsilon))`. DoG (Marr and Hildreth 1980): `strength * (G(sigma) - G(ratio sigma))`,
    which may be negative. With the flow (Kang et al. 2007), the two blurs run only across the lines, and a third one
    along them, which draws long smooth strokes. All work on the luminance as a display shows it (sRGB, 0..1). Alpha is
    kept.
    """

    aliases = ("dog", "xdog", "line drawing", "edge detect", "sketch", "ink", "lines", "photocopy", "pencil")

    proxy_notes = (ProxyNote(("out", "value"), "its lines have hard edges, and a proxy averages small specks away"),)

    image = Image()
    kind: Annotated[Literal["xdog", "dog"], Doc("XDoG draws black on white, DoG shows the difference itself.")] = "xdog"
    sigma: Annotated[float, Slider(0.3, 6.0, unit="px", minimum=0.05, maximum=500.0, doc="Width of the lines.")] = 1.0
    ratio: Annotated[
        float,
        Slider(
            1.1, 4.0, unit="ratio", minimum=1.0, maximum=16.0, doc="How much wider the second blur is: 1.6 is usual."
        ),
    ] = 1.6
    strength: Annotated[
        float,
        Slider(
            0.0,
            50.0,
            unit="ratio",
            minimum=0.0,
            doc="For XDoG p, the contrast of the lines; for DoG the factor on the difference.",
        ),
    ] = 20.0
    epsilon: Annotated[float, Slider(0.0, 1.0, unit="ratio", doc="For XDoG, epsilon: tones below this become ink.")] = (
        0.4
    )
    phi: Annotated[
        float,
        Slider(
            0.5,
            50.0,
            unit="ratio",
            minimum=0.0,
            doc="For XDoG, phi: how hard the border between ink and paper is; low values keep grays.",
        ),
    ] = 6.0
    guide: Annotated[
        Literal["none", "flow"],
        Doc("Blur in all directions, or only across the lines of the picture, found by the structure tensor."),
    ] = "none"
    smoothing: Annotated[
        float,
        Slider(
            0.5,
            8.0,
            unit="px",
            minimum=0.0,
            maximum=200.0,
            doc="For flow: sigma over which the directions of lines are averaged.",
        ),
    ] = 2.5
    stroke: Annotated[
        float,
        Slider(
            0.0,
            20.0,
            unit="px",
            minimum=0.0,
            maximum=500.0,
            doc="For flow: sigma of the blur along the lines.",
        ),
    ] = 3.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    out = OutputSocket()
    value = OutputSocket(Field(doc="The result as one number per pixel, before it becomes a gray."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn]:
        tone = draw.point("difference_of_gaussians_tone", self.image, result=Field())
        fine, coarse = (
            self._blur_along_edges(draw, tone)
            if self.guide == "flow"
            else (
                draw.blur(tone, self.sigma, self.edge, precise=True),
                draw.blur(tone, self.sigma * self.ratio, self.edge, precise=True),
            )
        )
        value = draw.point(
            "difference_of_gaussians_value",
            result=Field(),
            fine=fine,
            coarse=coarse,
            kind=self.kind,
            strength=self.strength,
            epsilon=self.epsilon,
            phi=self.phi,
        )
        return {"out": draw.point("difference_of_gaussians", self.image, value=value, kind=self.kind), "value": value}

    def _blur_along_edges(self, draw: Draw, tone: Drawn) -> tuple[Drawn, Drawn]:
        """The two blurs, across the lines only. The smoothed structure tensor says which way the lines run; both blurs
        are the channels of one picture, so that its directions are followed once for both.
        """
        changes = draw("difference_of_gaussians_changes", tone=tone, edge=self.edge, overlap=1, result=Vector(width=3))
        tensor = draw.blur(changes, self.smoothing, self.edge, precise=True)
        blurs = draw(
            "difference_of_gaussians_across",
            tone=tone,
            tensor=tensor,
            edge=self.edge,
            result=Vector(width=2),
            overlap={"tone": measure_reach(self.sigma * max(self.ratio, 0.0)), "tensor": 0},
            sigma=self.sigma,
            ratio=self.ratio,
        )
        if self.stroke > 0.0:
            blurs = draw(
                "difference_of_gaussians_along",
                blurs=blurs,
                tensor=tensor,
                edge=self.edge,
                result=Vector(width=2),
                overlap=measure_reach(self.stroke),
                stroke=self.stroke,
            )
        return (
            draw.point("difference_of_gaussians_fine", result=Field(), blurs=blurs),
            draw.point("difference_of_gaussians_coarse", result=Field(), blurs=blurs),
        )


def measure_reach(sigma: float) -> int:
    """How far away samples of a Gaussian are taken, in pixels: see the shader.

    They reach three sigmas, beyond which 0.3 % of a Gaussian lies, in at most 64 steps; half a step is added.
    """
    reach = 3.0 * max(sigma, 1e-3)
    return math.ceil(reach + 0.5 * max(1.0, reach / 64.0)) + 1

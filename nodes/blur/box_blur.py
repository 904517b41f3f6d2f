from itertools import accumulate
from math import floor
from typing import Annotated, Literal

from .._declare import Doc, Draw, Drawn, Edge, Filter, Image, OutputSocket, Pixels, ProxyNote, Slider, Vector

_DIRECT = 64
"""Up to this many weights in a row are applied one by one; longer rows are put together from blocks. Measured at
960x540 on one core of llvmpipe: 31 weights take 85 ms, 92 from blocks; 47 take 95 and 90; 63 take 132 and 97."""


class BoxBlur(Filter):
    """Blur evenly with a box: hard-edged and fast at any radius. Repeated, it comes close to a Gaussian.

    A box is 2 radius + 1 pixels wide. If the radius is not a whole number, the two pixels at its ends count in part.
    Wide boxes are added up from blocks, which is exact, so that the cost hardly grows with the radius. Three boxes that
    reach farther than 70 pixels are applied to a smaller picture; a single pixel then spreads as it should to within
    1e-3. Three boxes: Wells 1986, "Efficient Synthesis of Gaussian Filters by Cascaded Uniform Filters".
    """

    aliases = ("fast box blur", "fast blur", "average blur", "mean filter")

    proxy_notes = (ProxyNote(("out",), "a box is a whole number of pixels wide, and one more than twice the radius"),)

    image = Image()
    out = OutputSocket(follows="image")
    kind: Annotated[
        Literal["box", "tent", "iterated"],
        Doc(
            "Box weights all pixels equally. Tent, two boxes of half the radius, falls off linearly. "
            "Iterated, three boxes of a third, is nearly a Gaussian whose sigma is a third of the "
            "radius."
        ),
    ] = "box"
    radius: Annotated[
        float,
        Slider(
            0.0, 200.0, unit="px", minimum=0.0, maximum=2000.0, doc="How far a pixel spreads at most, along each axis."
        ),
    ] = 10.0
    edge: Annotated[Edge, Doc("What lies outside the picture.")] = "clamp"

    def identity(self) -> str | None:
        return "image" if self.radius == 0.0 else None

    def passes(self, draw: Draw) -> Drawn:
        times = {"box": 1, "tent": 2, "iterated": 3}[self.kind]
        radius = self.radius / times
        if self.kind == "iterated":
            return draw.spread(self.image, _weights(radius, times), self.edge)
        if 2.0 * self.radius < _DIRECT:
            weights = _weights(radius, times)
            return draw.convolve(draw.convolve(self.image, weights, "x", self.edge), weights, "y", self.edge)
        blurred: Pixels = self.image
        for axis in (0, 1):
            # Every box but the last also makes the pixels beyond the ends that those after it read.
            aprons = [remaining * (floor(radius) + 1) for remaining in reversed(range(times))]
            for before, apron in zip([0, *aprons], aprons, strict=False):
                blurred = self._box(draw, blurred, axis, radius, before, apron)
        assert not isinstance(blurred, Image)
        return blurred

    def _box(self, draw: Draw, image: Pixels, axis: int, radius: float, before: int, apron: int) -> Drawn:
        """One box along an axis of a picture that starts `before` pixels early; the result starts `apron` early.

        The picture is reduced to means of blocks once. A wide box is then the sum of `count` blocks, with the pixels at
        both ends that stand out or are missing subtracted or added one by one.
        """
        whole = floor(radius)
        stride, count = _blocks(2 * whole + 1)
        shift, lead = before - apron, stride * (whole // stride + 2)
        size = list(draw.size_of(image))
        full = size[axis] - 2 * shift
        size[axis] = (full + 2 * lead) // stride + 2
        blocks = draw(
            "box_blur_blocks",
            image=image,
            size=(size[0], size[1]),
            edge=self.edge,
            result=Vector(width=4),
            overlap=_along(axis, abs(shift) + lead + 3 * stride),
            axis=axis,
            first=shift - lead,
            stride=stride,
        )
        weights = (1.0 / count,) * count + (0.0,) * (1 - count % 2)
        size[axis] = full
        return draw(
            "box_blur",
            image=image,
            windows=draw.convolve(blocks, weights, "y" if axis else "x"),
            size=(size[0], size[1]),
            edge=self.edge,
            result=Vector(width=4) if apron else None,
            overlap={
                "image": _along(axis, abs(shift) + whole + 2 * stride + 3),
                "windows": _along(axis, lead // stride + 4),
            },
            axis=axis,
            shift=shift,
            whole=whole,
            part=radius - whole,
            stride=stride,
            count=count,
            lead=lead,
        )


def _along(axis: int, overlap: int) -> tuple[int, int]:
    """An overlap along one axis."""
    return (overlap, 0) if axis == 0 else (0, overlap)


def _blocks(width: int) -> tuple[int, int]:
    """How long blocks are and how many of them are summed at once, so that a row of `width` needs the fewest reads.

    Longer sums than of 64 would round off too much.
    """

    def cost(stride: int) -> float:
        return width / stride**2 / 3 + stride + abs(width - round(width / stride) * stride)

    stride = min(range(min(max(4, width // 64), 32), 33), key=cost)
    return stride, round(width / stride)


def _weights(radius: float, times: int) -> tuple[float, ...]:
    """A box of `radius` pixels, spread by itself `times` - 1 times."""
    whole = floor(radius)
    part, weights = radius - whole, [1.0]
    for _ in range(times):
        ends, last = [*accumulate(weights, initial=0.0)], len(weights)
        weights = [
            (1.0 - part) * (ends[min(i, last)] - ends[min(max(i - 2 * whole - 1, 0), last)])
            + part * (ends[min(i + 1, last)] - ends[max(i - 2 * whole - 2, 0)])
            for i in range(last + 2 * whole + 2)
        ]
    return tuple(weight / (2.0 * radius + 1.0) ** times for weight in weights)

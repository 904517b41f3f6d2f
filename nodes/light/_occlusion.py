"""What measures of occlusion share."""

from .._declare import Draw, Drawn, Pixels, Size, Vector

DATA = Vector(width=4)

SAMPLES = {"preview": (3, 3), "quality": (4, 8), "reference": (16, 16)}
"""Slices, and steps to either side of each: twice their product is how many times depth is read."""

FACTORS = {"full": 1, "half": 2}
"""Of every how many pixels one is measured, along each axis."""


def measure_size(size: Size, factor: int) -> Size:
    """How many pixels are measured."""
    return -(-size[0] // factor), -(-size[1] // factor)


def denoise_and_enlarge(
    draw: Draw,
    id: str,
    depth: Pixels,
    normal: Pixels,
    occlusion: Drawn,
    rays: tuple[float, ...],
    factor: int,
    denoise: bool,
) -> Drawn:
    """What was measured at every `factor`-th pixel, without noise and at full size, by functions of node `id`."""
    if denoise:
        occlusion = draw(
            f"{id}_denoise",
            depth=depth,
            normal=normal,
            open=occlusion,
            size=occlusion.size,
            result=DATA,
            rays=rays,
            factor=factor,
        )
    if factor == 1:
        return occlusion
    return draw(f"{id}_enlarge", depth=depth, normal=normal, open=occlusion, result=DATA, rays=rays, factor=factor)

"""What rays march through: the picture of all surfaces of shaders/lib/march.glsl."""

from .._declare import Draw, Drawn, Field, Vector

_LEVELS = 3


def surfaces(draw: Draw, depth: Field, owner: str) -> Drawn:
    """Every pixel as a small plane, and below them what cells of 4, 16 and 64 pixels hold.

    The owner's GLSL file has a function for each of the three draws, which calls the one of march.glsl.
    """
    width, height = draw.size
    cells = [(-(-width // 4**level), -(-height // 4**level)) for level in range(1, _LEVELS + 1)]
    texels = Vector(width=3)
    planes = draw(f"{owner}_planes", depth=depth, edge="black", result=texels)
    bounds = draw(f"{owner}_bounds", planes=planes, edge="black", size=cells[0], result=texels)
    whole = (max(width, sum(across for across, _ in cells)), height + cells[0][1])
    return draw(f"{owner}_surfaces", planes=planes, bounds=bounds, edge="black", size=whole, result=texels)

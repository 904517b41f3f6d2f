from typing import Annotated

from .._declare import Image, Pointwise, Slider


class MixImages(Pointwise):
    """Mix two pictures, as a dissolve: `a (1 - factor) + b factor`. Link a Field to the factor to mix by a mask."""

    aliases = (
        "mix", "dissolve", "cross dissolve", "key mix", "keymix", "crossfade", "blend", "fade", "lerp", "interpolate",
        "mix color", "wipe", "cross fade", "opacity", "transition", "split", "time dissolve", "add mix", "blend mat",
        "gradient wipe", "linear wipe", "iris wipe", "block dissolve", "cross top",
    )  # fmt: skip

    a = Image()
    b = Image()
    factor: Annotated[
        float,
        Slider(0.0, 1.0, unit="ratio", doc="0 is a, 1 is b. Values beyond exaggerate the difference between both."),
    ] = 0.5

    def identity(self) -> str | None:
        return {0.0: "a", 1.0: "b"}.get(self.factor)

from collections.abc import Mapping
from typing import Annotated

from .._declare import Image, OutputSocket, Pointwise, Size, Slider, Trait


class Select(Pointwise):
    """Show one of several pictures, by number. What is not chosen is not computed.

    Give the number keys or an expression to choose by the frame, such as `=frame < 24 ? 1 : 2`. The result has the size
    of the picture that is chosen; without a link it is transparent black.
    """

    aliases = (
        "switch", "select", "choose", "which", "input switch", "multi switch", "toggle", "a b", "version", "variant",
        "dissolve", "pick input", "layer switch", "compare", "index switch", "menu switch", "if else", "append clip",
    )  # fmt: skip

    traits = (Trait.KEEPS_NON_FINITE,)

    a = Image(0.0, doc="Number 1.")
    b = Image(0.0, doc="Number 2.")
    c = Image(0.0, doc="Number 3.")
    d = Image(0.0, doc="Number 4.")
    e = Image(0.0, doc="Number 5.")
    f = Image(0.0, doc="Number 6.")
    g = Image(0.0, doc="Number 7.")
    h = Image(0.0, doc="Number 8.")
    which: Annotated[
        int, Slider(1, 8, unit="count", minimum=1, maximum=8, doc="The number of the picture that is shown.")
    ] = 1

    out = OutputSocket()

    def identity(self) -> str | None:
        return "abcdefgh"[self.which - 1]

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        return inputs.get("abcdefgh"[self.which - 1], canvas)

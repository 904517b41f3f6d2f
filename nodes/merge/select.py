from collections.abc import Mapping
from typing import Annotated

from .._declare import Doc, Image, OneOf, OutputSocket, Pointwise, Size, Slider, Trait, find_number

_INPUTS = "abcdefgh"


class Select(Pointwise):
    """Show one of several pictures, by name or by number. What is not chosen is not computed.

    List the names, such as `day, dusk, night`, and choose one of them; a control of that is a list of the names. Or
    give the number keys or an expression to choose by the frame, such as `=frame < 24 ? 1 : 2`. The result has the size
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
        int,
        Slider(
            1, 8, unit="count", minimum=1, maximum=8,
            doc="The number of the picture that is shown, where none is chosen. A measured number counts in any case.",
        ),
    ] = 1  # fmt: skip
    names: Annotated[str, Doc("What the pictures are called, from the first on, with commas between.")] = ""
    choice: Annotated[str, OneOf("names", len(_INPUTS)), Doc("The picture that is shown, by its name or number.")] = ""

    out = OutputSocket()

    def identity(self) -> str | None:
        return _INPUTS[self._find_chosen() - 1]

    def output_size(self, inputs: Mapping[str, Size], canvas: Size) -> Size:
        return inputs.get(_INPUTS[self._find_chosen() - 1], canvas)

    def _find_chosen(self) -> int:
        number = find_number(self.names, self.choice)
        return number if number and number <= len(_INPUTS) else self.which

from typing import Annotated

from .._declare import Doc, Field, Image, OutputSocket, Pointwise, ProxyNote, Slider, Vector


class BlueNoise(Pointwise):
    """Random dots that never clump: the least visible noise, for the thresholds of dissolves and stipples.

    Void and cluster (Ulichney, 1993): 64 x 64 cells that repeat, with 256 values that are equally frequent. It has
    almost no low frequencies.
    """

    aliases = ("white noise", "dither pattern", "random", "noise pattern", "noise")

    proxy_notes = (ProxyNote(("out", "value", "vector"), "every pixel has its own random number", "look"),)

    size: Annotated[float, Slider(1.0, 16.0, unit="px", minimum=0.01, doc="Side of a cell, at least one pixel.")] = 1.0
    seed: Annotated[int, Slider(0, 1000, unit="count", doc="Another number gives another pattern.")] = 0
    animate: Annotated[bool, Doc("Another pattern for each frame.")] = False

    out = OutputSocket(Image(doc="The value as an opaque gray."))
    value = OutputSocket(Field(doc="Between 0 and 1, 0.5 on average."))
    vector = OutputSocket(Vector(width=2, doc="Two more noises, each -1..1 with average 0."))

from typing import Annotated

from .._declare import Doc, Field, OutputSocket, Pointwise, Slider


class DepthSlice(Pointwise):
    """Make a mask of the surfaces between two distances.

    It is 1 from near to far. Outside of that range it falls to 0 over the softness, linearly in depth. A far softness
    as long as the scene makes a ramp of the depth. Pixels without depth are farther than everything.
    """

    aliases = (
        "zslice", "z slice", "depth matte", "depth mask", "depth key", "z matte", "z mask",
        "depth range", "isolate depth", "z depth mask",
    )  # fmt: skip

    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    near: Annotated[float, Slider(0.0, 100.0, unit="scene", minimum=0.0, doc="Nearer pixels are cut away.")] = 6.0
    far: Annotated[float, Slider(0.0, 100.0, unit="scene", minimum=0.0, doc="Farther pixels are cut away.")] = 9.0
    near_softness: Annotated[
        float, Slider(0.0, 20.0, unit="scene", minimum=0.0, doc="The mask rises over this much depth before `near`.")
    ] = 1.0
    far_softness: Annotated[
        float, Slider(0.0, 20.0, unit="scene", minimum=0.0, doc="The mask falls over this much depth beyond `far`.")
    ] = 1.0
    invert: Annotated[bool, Doc("Mask everything outside of the slice.")] = False

    mask = OutputSocket(Field(doc="How much of each pixel is in the slice, 0..1."))

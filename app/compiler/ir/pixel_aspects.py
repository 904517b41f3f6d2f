"""The shape of the pixels of pictures.

As in OpenEXR, the pixel aspect ratio of a picture is the width of a pixel over its height, as it is to be shown: 2 for
an anamorphic plate. Nodes count in pixels whatever their shape is, so it changes nothing in a plan; it goes with the
picture to the viewer and into files. A picture has that of the first file that it is made of; generated pictures, which
take the shape of what they are mixed with, have none of their own. `resize` makes pixels narrower as it makes the
picture wider, so that the picture keeps its shape.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from .operation import Op
from .operations import Gather, Read
from .values import Ref


def find_pixel_aspects(ops: Iterable[Op]) -> Mapping[Ref, float]:
    """The pixel aspect ratios of all pictures that are made of files; empty if all pixels are square."""
    ops = tuple(ops)
    if all(op.pixel_aspect == 1.0 for op in ops if isinstance(op, Read)):
        return MappingProxyType({})
    aspects: dict[Ref, float] = {}
    for index, op in enumerate(ops):
        aspect = _find_own(op, ops, aspects)
        if aspect is not None:
            aspects |= {Ref(index, output): aspect for output in range(op.outputs)}
    return MappingProxyType(aspects)


def _find_own(op: Op, ops: tuple[Op, ...], aspects: Mapping[Ref, float]) -> float | None:
    """That of an operation's pictures; None if it reads no picture that has one."""
    if isinstance(op, Read):
        return op.pixel_aspect if op.size != (1, 1) else None
    source = next((ref for ref in op.reads() if ref in aspects), None)
    if source is None or op.size == (1, 1):
        return None
    aspect = aspects[source]
    if not (isinstance(op, Gather) and op.stretches):
        return aspect
    before = ops[source.op].size
    stretched = aspect * before[0] / op.size[0] * op.size[1] / before[1]
    # The size is rounded to whole pixels, so pixels that were to be square are so only up to one of them.
    return 1.0 if abs(stretched - 1.0) <= 1.0 / min(op.size) else stretched

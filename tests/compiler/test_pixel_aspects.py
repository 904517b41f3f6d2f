"""The shape of pixels goes from files through operations; pictures of other sizes stretch it."""

from __future__ import annotations

import pytest
from halation.compiler.ir import PictureShape
from halation.compiler.ir.operations import Accessor, Gather, Op, Read, Reduce
from halation.compiler.ir.pixel_aspects import find_pixel_aspects
from halation.compiler.ir.values import Ref
from halation.nodes import Kind
from halation.resources.picture import Picture

PICTURE = Picture("p.exr", "", Kind.IMAGE, 4)


def shape(width: int, height: int) -> tuple[PictureShape, ...]:
    return (PictureShape((width, height), 4, False),)


def read(aspect: float, width: int = 80, height: int = 60) -> Read:
    return Read(shape(width, height), "n", PICTURE, "mark", half=False, pixel_aspect=aspect)


def gather(width: int, height: int, source: int = 0, *, stretches: bool = False) -> Op:
    accessors = (Accessor("image", "vec4", Ref(source)),)
    return Gather(shape(width, height), "n", "a/b", "b", (), (), accessors=accessors, stretches=stretches)


def test_square_pixels_need_no_word() -> None:
    assert find_pixel_aspects([read(1.0), gather(40, 30)]) == {} == find_pixel_aspects([])


@pytest.mark.parametrize("aspect", [2.0, 0.5, 1.46])
def test_what_is_made_of_a_file_has_its_pixels(aspect: float) -> None:
    ops = [read(aspect), gather(40, 30), read(1.0), gather(9, 9, source=2)]
    assert find_pixel_aspects(ops) == {Ref(0): aspect, Ref(1): aspect, Ref(2): 1.0, Ref(3): 1.0}


def test_one_pixel_has_no_shape() -> None:
    ops = [read(2.0), Reduce(shape(1, 1), "n", Ref(0), "sum"), gather(8, 8, source=1), read(2.0, 1, 1)]
    assert find_pixel_aspects(ops) == {Ref(0): 2.0}


@pytest.mark.parametrize(
    ("size", "aspect"), [((160, 60), 1.0), ((80, 60), 2.0), ((80, 30), 1.0), ((40, 60), 4.0), ((159, 60), 1.0)]
)
def test_stretched_pixels(size: tuple[int, int], aspect: float) -> None:
    """The picture keeps its shape on the screen: 80 pixels twice as wide as high are as wide as 160 square ones."""
    assert find_pixel_aspects([read(2.0), gather(*size, stretches=True)])[Ref(1)] == pytest.approx(aspect)


def test_pixels_that_are_not_nearly_square_stay_as_they_are() -> None:
    assert find_pixel_aspects([read(2.0), gather(150, 60, stretches=True)])[Ref(1)] == pytest.approx(160 / 150)

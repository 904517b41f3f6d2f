"""The key of a picture depends on every field of the operation that makes it, except those declared not to matter."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from enum import Enum
from typing import Any

import pytest
from halation.compiler import NULL
from halation.compiler.areas import Neighborhood, Region
from halation.compiler.fusion.fuse import PassGroup
from halation.compiler.ir import (
    Accessor,
    Call,
    Choice,
    ColorCall,
    Convolve,
    ExternalProgram,
    FormulaCall,
    FunctionOp,
    Gather,
    HistoryRead,
    HostCall,
    LoweredProgram,
    Op,
    OpaqueProgram,
    Parameter,
    PictureShape,
    Placement,
    Raster,
    Read,
    Reduce,
    Ref,
    SourceOp,
    StoredResult,
    UniformConstant,
)
from halation.compiler.ir.identity import hash_description
from halation.compiler.scheduling.fingerprints import PassFingerprints, find_keys
from halation.glsl import parse
from halation.nodes import HostProgram, Kind, ShaderStage, ShaderText
from halation.resources.color_program import ColorProgram, LookupTable
from halation.resources.mesh import Mesh
from halation.resources.picture import Picture
from msgspec import Struct
from msgspec.structs import replace

SHAPE = PictureShape((8, 6), 4, data=False)
SHAPES = (SHAPE,)
PICTURE = Picture("a.exr", "beauty", Kind.IMAGE, 4, rows=(0, 6), within="folder", space="linear")
PARAMETERS = (
    Parameter("vec4", Ref(0), 2.0, 0.0, 1.0),
    Parameter("float", UniformConstant(3.0)),
    Parameter("int", Choice(1)),
)
CHOICES = (("mode", ("a", "b")),)
AROUND = Neighborhood((1.0, 0.0, 0.0, 0.0, 1.0, 0.0), (2.0, 2.0))
ACCESSORS = (Accessor("image", "vec4", Ref(0), AROUND), Accessor("mask", "float", UniformConstant(1.0), AROUND))
PROGRAM = ColorProgram(
    "color_change", parse("color", "vec4 color_change(vec4 c) { return c; }"), (LookupTable("t", True, 0),)
)
TEXT = ShaderText(ShaderStage("head", "text", "tail", "a.fs"), ShaderStage("head", "text", "tail", "a.vs"))

SPECIMENS: dict[type[Op], Op] = {
    type(op): op
    for op in (
        Read(SHAPES, "n", PICTURE, "fingerprint", half=False, data_window=Region(-1, -1, 6, 5)),
        HistoryRead(SHAPES, "n", "key", half=False, data_window=Region(-1, -1, 6, 5)),
        StoredResult(SHAPES, "n", (PICTURE,), (False,), ("key",)),
        Call(SHAPES, "n", "color/exposure", "exposure", PARAMETERS, CHOICES),
        ColorCall(SHAPES, "n", "color", "color_change", PARAMETERS, CHOICES, program=PROGRAM),
        FormulaCall(SHAPES, "n", "merge/pixel_formula", "formula_1", PARAMETERS, CHOICES, program=PROGRAM),
        Gather(SHAPES, "n", "edge/edge", "edge", PARAMETERS[1:], CHOICES, accessors=ACCESSORS, ends_as=(Ref(0), 1)),
        Placement(
            SHAPES,
            "n",
            "primitive/place",
            "place",
            PARAMETERS[1:],
            CHOICES,
            accessors=ACCESSORS,
            ends_as=(Ref(0), 1),
            chain=("n",),
        ),
        Convolve(SHAPES, "n", Ref(0), 0, (0.25, 0.5, 0.25), 1, -1, "clamp"),
        Reduce(SHAPES, "n", Ref(0), "sum"),
        ExternalProgram(SHAPES, "n", TEXT, (("image", Ref(0)),), (("gain", UniformConstant(1.0)),)),
        HostCall(SHAPES, "n", HostProgram("denoise", (("hdr", True),)), (("color", Ref(0)), ("normal", Ref(1)))),
        Raster(SHAPES, "n", Mesh("digest", 0, 0), (1.0, 2.0), (3.0, 4.0), 0.1),
    )
}
"""One of each kind, with something in every field."""


class Files:
    """Stands for the library: operations here call functions that are in no file."""

    def digest(self, names: tuple[str, ...], asker: str) -> str:
        return f"{names}"

    def find_uniforms(self, shader: str, function: str, asker: str) -> frozenset[str]:
        return frozenset()


def concrete(kind: type[Op] = Op) -> Iterator[type[Op]]:
    """All kinds of operations that programs hold."""
    for child in kind.__subclasses__():
        yield from concrete(child)
        if child not in (SourceOp, FunctionOp, OpaqueProgram):
            yield child


def key(op: Op) -> str:
    """The key of what an operation makes of two pictures."""
    sources = [Read(SHAPES, name, replace(PICTURE, path=name), name, half=False) for name in ("first", "second")]
    program = LoweredProgram((*sources, op), {}, {}, {}, {}, 1.0, 1)
    made, formats = Ref(2), dict.fromkeys((Ref(0), Ref(1), Ref(2)), "rgba32f")
    if op.is_source:
        return find_keys(program, (), [made])[made]
    reads = tuple(dict.fromkeys(op.reads()))
    fingerprints = PassFingerprints(program, Files(), NULL, formats).of(PassGroup((2,), reads, (made,)))
    return find_keys(program, (fingerprints,), [Ref(0), Ref(1)])[made]


def changes(item: Any, path: str) -> Iterator[tuple[str, bool, Any]]:
    """Where a value can be changed, whether that place is declared not to matter, and the value changed there."""
    if isinstance(item, Ref):
        yield path, False, Ref(1 - item.op)
    elif isinstance(item, Struct):
        excluded = {*getattr(item, "identity_exclude", ()), *getattr(item, "compare_exclude", ())}
        for name in item.__struct_fields__:
            for place, beside, other in changes(getattr(item, name), f"{path}.{name}"):
                yield place, beside or name in excluded, replace(item, **{name: other})
    elif dataclasses.is_dataclass(item):
        for field in dataclasses.fields(item):
            for place, beside, other in changes(getattr(item, field.name), f"{path}.{field.name}"):
                yield place, beside, dataclasses.replace(item, **{field.name: other})
    elif isinstance(item, tuple):
        for at, part in enumerate(item):
            for place, beside, other in changes(part, f"{path}[{at}]"):
                yield place, beside, (*item[:at], other, *item[at + 1 :])
    elif isinstance(item, Enum):
        yield path, False, next(other for other in type(item) if other is not item)
    elif isinstance(item, bool):
        yield path, False, not item
    elif isinstance(item, str):
        yield path, False, f"{item}_"
    elif isinstance(item, int | float):
        yield path, False, item + 1 if math.isfinite(item) else 0


def test_there_is_a_specimen_of_every_kind():
    assert set(concrete()) == set(SPECIMENS)


@pytest.mark.parametrize("kind", SPECIMENS, ids=lambda kind: kind.__name__)
def test_a_key_changes_with_every_field_that_matters(kind):
    op, seen = SPECIMENS[kind], set[str]()
    for place, beside, other in changes(op, kind.__name__):
        seen.add(place)
        assert (key(other) == key(op)) == beside, place
    tops = {place.removeprefix(f"{kind.__name__}.").partition(".")[0].partition("[")[0] for place in seen}
    assert tops == set(op.__struct_fields__)


@pytest.mark.parametrize("kind", [*SPECIMENS, Accessor, ShaderStage], ids=lambda kind: kind.__name__)
def test_what_does_not_matter_says_why(kind):
    for name, reason in kind.identity_exclude.items():
        assert name in kind.__struct_fields__ and reason


def test_equal_numbers_have_one_key():
    call = SPECIMENS[Call]
    one, other = (replace(call, parameters=(Parameter("float", UniformConstant(number)),)) for number in (1, 1.0))
    assert one == other and key(one) == key(other)
    still = SPECIMENS[Placement]
    turned = replace(still, matrix=tuple(-0.0 if number == 0.0 else number for number in still.matrix))
    assert turned == still and key(turned) == key(still)


@pytest.mark.parametrize(
    ("first", "second"), [("\udce9.exr", "\udcea.exr"), (1 << 70, 1 << 71), (1, 1.0), (0.0, False)]
)
def test_values_that_differ_have_other_hashes(first: object, second: object) -> None:
    """Also file names that are not UTF-8, and whole numbers that MessagePack cannot write."""
    assert hash_description(["Read", first]) != hash_description(["Read", second])
    assert hash_description(["Read", first]) == hash_description(["Read", first])

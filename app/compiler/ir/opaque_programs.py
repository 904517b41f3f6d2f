"""Operations that the compiler runs without looking into them: programs of users, and programs on the processor."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from halation.nodes import HostProgram, ShaderText, Size
from msgspec.structs import replace

from ..library import Library
from .operation import Op
from .values import Ref, UniformConstant


class OpaqueProgram(Op, frozen=True):
    """A program that reads whole pictures, by the names that it has for them, and makes a whole picture.

    What it reads for a pixel is not known: so it is no part of another pass, and it is never made in tiles.
    """

    program: object
    pictures: tuple[tuple[str, Ref], ...]

    is_fragment_only: ClassVar[bool] = True

    @property
    def is_indivisible(self) -> bool:
        return True

    def reads(self) -> Iterator[Ref]:
        return (ref for _, ref in self.pictures)

    def reads_whole(self, ref: Ref, size: Size) -> bool:
        return True


class ExternalProgram(OpaqueProgram, frozen=True):
    """A vertex and a fragment shader of another format: its pictures by sampler, its uniforms by name."""

    program: ShaderText
    uniforms: tuple[tuple[str, UniformConstant], ...]

    @property
    def label(self) -> str:
        return self.program.fragment.file.rpartition("/")[2]

    def without_numbers(self) -> ExternalProgram:
        return replace(self, uniforms=tuple((name, item.blank) for name, item in self.uniforms))

    def find_user_files(self, library: Library) -> tuple[str, ...]:
        return tuple(stage.file for stage in (self.program.fragment, self.program.vertex) if stage)


class HostCall(OpaqueProgram, frozen=True):
    """A program on the processor.

    Its pass has no shader. The pictures that it reads are downloaded, the program runs on a thread of its own, and its
    picture is uploaded: see `renderer.execution.host_jobs`. To all other stages it is a pass like others, with a key of
    the program, its settings and the keys of its pictures. So it runs again only when one of these changes.
    """

    program: HostProgram

    rounds_halves: ClassVar[bool] = False

    @property
    def label(self) -> str:
        return self.program.name.replace("_", " ")

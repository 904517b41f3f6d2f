"""The operation that runs on the processor."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from halation.nodes import HostProgram, Size

from .operation import Op
from .values import Ref


class HostCall(Op, frozen=True):
    """A program on the processor, which reads whole pictures and makes a whole picture: no tile, and no part of a pass.

    Its pass has no shader. The pictures that it reads are downloaded, the program runs on a thread of its own, and its
    picture is uploaded: see `renderer.execution.host_jobs`. To all other stages it is a pass like others, with a key of
    the program, its settings and the keys of its pictures. So it runs again only when one of these changes.
    """

    program: HostProgram
    pictures: tuple[tuple[str, Ref], ...]

    is_fragment_only: ClassVar[bool] = True
    rounds_halves: ClassVar[bool] = False

    @property
    def label(self) -> str:
        return self.program.name.replace("_", " ")

    @property
    def is_indivisible(self) -> bool:
        return True

    def reads(self) -> Iterator[Ref]:
        return (ref for _, ref in self.pictures)

    def reads_whole(self, ref: Ref, size: Size) -> bool:
        return True

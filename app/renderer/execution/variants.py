"""Programs that are compiled on other threads before their passes run."""

from __future__ import annotations

import time
from collections.abc import Iterable
from concurrent.futures import Future

from msgspec import Struct, field

from ...compiler import Pass, Plan, Shader
from ..device import Device, ImageKind, ProgramVariant
from .program_cache import ProgramCache


class PendingPrograms(Struct, eq=False):
    """The programs of one renderer that its device compiles ahead, by their text."""

    device: Device
    programs: ProgramCache
    _futures: dict[Shader, list[Future[float]]] = field(default_factory=dict[Shader, list[Future[float]]])

    def begin(self, plan: Plan, passes: Iterable[Pass]) -> None:
        """Begin to compile the programs of passes that this renderer has not compiled yet."""
        variants = dict[ProgramVariant, Shader]()
        for render_pass in passes:
            if _is_compiled_alone(render_pass) and render_pass.shader not in self.programs:
                variants[_describe(plan, render_pass)] = render_pass.shader
        for variant, future in self.device.precompile(tuple(variants)).items() if variants else ():
            self._futures.setdefault(variants[variant], []).append(future)

    def are_ready(self, render_pass: Pass) -> bool:
        """False while the program of a pass is being compiled, which `wait_for` would wait for."""
        now = time.monotonic()
        futures = self._futures.get(render_pass.shader, ())
        return all(future.done() and future.result() <= now for future in futures)

    def wait_for(self, render_pass: Pass) -> None:
        """Wait until the program of a pass can be created without compiling it."""
        for future in self._futures.pop(render_pass.shader, ()):
            time.sleep(max(future.result() - time.monotonic(), 0.0))


def _is_compiled_alone(render_pass: Pass) -> bool:
    """True if nothing but its text and its images decides about the code of a program.

    Code of users is compiled where somebody watches it. Samplers of tables, and draws, have more kinds of state.
    """
    shader = render_pass.shader
    return shader.form == "compute" and shader.reads_images and not (render_pass.writers or render_pass.tables)


def _describe(plan: Plan, render_pass: Pass) -> ProgramVariant:
    """A program with the kinds of its images."""
    textures, targets = (
        tuple(
            ImageKind(_is_power(surface.size[0]), _is_power(surface.size[1]), surface.components, surface.depth)
            for surface in map(plan.surfaces.__getitem__, numbers)
        )
        for numbers in (render_pass.textures, render_pass.targets)
    )
    return ProgramVariant(render_pass.shader.source, textures, targets)


def _is_power(length: int) -> bool:
    return length & (length - 1) == 0

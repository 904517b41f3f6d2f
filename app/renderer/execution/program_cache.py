"""Compiled programs by source. A value never changes a source, so dragging a slider compiles nothing."""

from __future__ import annotations

import re
from functools import partial

from ...compiler import FIRST_TABLE, Pass, Shader
from ...custom_nodes import strip_prefix
from ...errors import DeviceError, ShaderError
from ..device import Device, DeviceProgram
from .resource_cache import ResourceCache

# Mesa: "2:14(5): error: ...", NVIDIA: "2(14) : error ...", Apple and AMD: "ERROR: 2:14: ..."
_FAULT = re.compile(r"(?:ERROR:\s*)?(\d+)(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:\s*(.*)")

MAX_PROGRAMS = 512
"""Programs that are kept: fifteen times as many as the largest preset has (34), so that only hours of editing reach
it."""


class ProgramCache:
    """Compiles the programs of passes on first use."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._programs = ResourceCache[Shader, DeviceProgram](MAX_PROGRAMS)
        self.compiled = 0
        """Programs compiled so far."""

    def get(self, render_pass: Pass) -> DeviceProgram:
        """The program of a pass. Raises ShaderError with node, file and line where the driver refuses it."""
        return self._programs.get(render_pass.shader, partial(self._compile, render_pass))

    def __contains__(self, shader: Shader) -> bool:
        return shader in self._programs

    def clear(self) -> None:
        """Give everything back to the driver."""
        self._programs.clear()

    def _compile(self, render_pass: Pass) -> DeviceProgram:
        shader = render_pass.shader
        try:
            if shader.form == "compute":
                program = self._device.create_compute_program(shader.source)
            else:
                program = self._device.create_program(shader.source, shader.vertex)
        except DeviceError as fault:
            raise _locate_fault(render_pass, str(fault)) from None
        self.compiled += 1
        for unit, table in enumerate(render_pass.tables, FIRST_TABLE):
            program.set(table.sampler, unit)
        if shader.form == "fragment" and not shader.foreign:
            for unit in range(len(render_pass.textures)):
                program.set(f"t{unit}", unit)
        return program


def _locate_fault(render_pass: Pass, log: str) -> ShaderError:
    """The first fault in a driver's log, in terms of the user's files."""
    shader, nodes = render_pass.shader, ", ".join(render_pass.nodes)
    for line in log.splitlines():
        match = _FAULT.match(line.strip())
        if match and not match[4].lower().startswith("warning"):
            name, row = shader.locate(int(match[2] or match[3]))
            return ShaderError(render_pass.writers.get(name, nodes), name, row, strip_prefix(match[4].strip()))
    first = next((line.strip() for line in log.splitlines() if "error" in line.lower()), log.strip())
    return ShaderError(nodes, shader.files[-1], 1, first)

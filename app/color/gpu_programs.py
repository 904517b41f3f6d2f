"""Changes of color as GLSL, written by OpenColorIO: what it computes on the CPU, exactly."""

from __future__ import annotations

from functools import cache, lru_cache
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np
from halation.nodes import ColorChange, ColorSettings, LookupFile, SpaceChange

from ..errors import InputError, UsageError
from ..glsl import parse
from ..resources.color_program import ColorProgram, LookupTable
from ..resources.input_files import fingerprint
from .management import DEFAULT_COLOR, Space, color_mark, faults, managed, ocio
from .transforms import display_processor


def recolor(change: ColorChange) -> ColorProgram:
    """The program of a change of color.

    Raises:
        InputError: the file is missing or no table that OpenColorIO can read.
        UsageError: a color space that nobody knows.
        GraphError, UsageError: no config.
    """
    return _recolor(change, fingerprint(change.path) if isinstance(change, LookupFile) else color_mark(change.color))


@cache
def table_endings() -> frozenset[str]:
    """Endings of names of files that hold tables of colors, such as `.cube`."""
    return frozenset(f".{ending.lower()}" for _, ending in ocio().FileTransform.getFormats())


def color_program(processor: Any, name: str) -> ColorProgram:
    """A processor of OpenColorIO as GLSL. Functions, samplers and constants begin with `name`."""
    api = ocio()
    made = api.GpuShaderDesc.CreateShaderDesc(
        language=api.GPU_LANGUAGE_GLSL_4_0, functionName=name, resourcePrefix=f"{name}_"
    )
    made.setAllowTexture1D(False)
    processor.getDefaultGPUProcessor().extractGpuShaderInfo(made)
    tables: list[LookupTable] = []
    for table in made.getTextures():
        channels = 1 if table.channel == made.TEXTURE_RED_CHANNEL else 3
        values = np.array(table.getValues(), np.float32).reshape(table.height, table.width, channels)
        tables.append(LookupTable(table.samplerName, table.interpolation != api.INTERP_NEAREST, values))
    for cube in made.get3DTextures():
        values = np.array(cube.getValues(), np.float32).reshape(*[cube.edgeLen] * 3, 3)
        tables.append(LookupTable(cube.samplerName, cube.interpolation != api.INTERP_NEAREST, values))
    return ColorProgram(name, parse(f"OpenColorIO/{name}", made.getShaderText()), tuple(tables))


def gpu_view(view: str = "", display: str = "", look: str = "", color: ColorSettings = DEFAULT_COLOR) -> ColorProgram:
    """The program that computes what `to_display` computes, from straight working-space color.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config.
    """
    return color_program(display_processor(view, display, look, color), "view_transform")


@lru_cache(maxsize=64)
def _recolor(change: ColorChange, mark: str) -> ColorProgram:
    name = f"recolor_{blake2b(f'{change} {mark}'.encode(), digest_size=8).hexdigest()}"
    return color_program(_of_file(change) if isinstance(change, LookupFile) else _of_spaces(change), name)


def _of_spaces(change: SpaceChange) -> Any:
    manager = managed(change.color)

    def found(name: str) -> Space:
        space = manager.find(name)
        if space is None:
            raise UsageError(f"no color space is called '{name}'{manager.hint(name)}")
        return space

    return manager.processor(found(change.source), found(change.target))


def _of_file(change: LookupFile) -> Any:
    api = ocio()
    if not Path(change.path).is_file():
        raise InputError(f"{change.path}: there is no such file: choose a table (.cube, .3dl, .clf, ...)")
    api.ClearAllCaches()  # files that have changed are to be read again; a config would remember them, too
    way = api.TRANSFORM_DIR_INVERSE if change.inverse else api.TRANSFORM_DIR_FORWARD
    transform = api.FileTransform(change.path, interpolation=api.INTERP_BEST, direction=way)
    try:
        return api.Config.CreateRaw().getProcessor(transform)
    except faults() as error:
        reason = str(error).strip().splitlines()[0]
        raise InputError(f"{change.path}: is no color table that can be read: {reason}") from error

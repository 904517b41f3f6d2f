"""Color changes as GLSL, written by OpenColorIO. They compute exactly what it computes on the CPU."""

from __future__ import annotations

from functools import cache, lru_cache
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np
from halation.nodes import ColorChange, LookupFile, SpaceChange

from ..errors import InputError, UsageError
from ..glsl import parse
from ..resources.color_program import ColorProgram, LookupTable
from ..resources.input_files import fingerprint
from ..resources.library_names import name_for_library
from ..resources.sandbox import Sandbox
from .config_files import check_table, make_sandboxed_files, may_name_files
from .display import make_display_processor
from .management import ColorManager, OcioColorSpace, describe_ocio_error, get_color_manager, load_ocio, ocio_errors

_UNNAMED = "recolor_unnamed"
"""The name of a program until its content is known."""


def write_color_change(change: ColorChange, sandbox: Sandbox) -> ColorProgram:
    """The program of a change of color.

    Raises:
        InputError: the file is missing or no table that OpenColorIO can read.
        UsageError: a color space that nobody knows.
        GraphError, UsageError: no config.
    """
    is_file = isinstance(change, LookupFile)
    mark = fingerprint(change.path, sandbox) if is_file else get_color_manager(change.color, sandbox).mark
    return _write_color_change(change, mark, sandbox)


@cache
def list_table_endings() -> frozenset[str]:
    """File name endings of color tables, such as `.cube`."""
    return frozenset(f".{ending.lower()}" for _, ending in load_ocio().FileTransform.getFormats())


def write_color_program(processor: Any, name: str) -> ColorProgram:
    """A processor of OpenColorIO as GLSL. Functions, samplers and constants begin with `name`."""
    api = load_ocio()
    shader = api.GpuShaderDesc.CreateShaderDesc(
        language=api.GPU_LANGUAGE_GLSL_4_0, functionName=name, resourcePrefix=f"{name}_"
    )
    shader.setAllowTexture1D(False)
    processor.getDefaultGPUProcessor().extractGpuShaderInfo(shader)
    tables: list[LookupTable] = []
    for table in shader.getTextures():
        channels = 1 if table.channel == shader.TEXTURE_RED_CHANNEL else 3
        values = np.array(table.getValues(), np.float32).reshape(table.height, table.width, channels)
        tables.append(LookupTable(table.samplerName, table.interpolation != api.INTERP_NEAREST, values))
    for cube in shader.get3DTextures():
        values = np.array(cube.getValues(), np.float32).reshape(*[cube.edgeLen] * 3, 3)
        tables.append(LookupTable(cube.samplerName, cube.interpolation != api.INTERP_NEAREST, values))
    return ColorProgram(name, parse(f"OpenColorIO/{name}", shader.getShaderText()), tuple(tables))


def write_view_program(
    view: str = "", display: str = "", look: str = "", manager: ColorManager | None = None
) -> ColorProgram:
    """The program that computes what `to_display` computes, from straight working-space color.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config.
    """
    return write_color_program(make_display_processor(view, display, look, manager), "view_transform")


@lru_cache(maxsize=64)
def _write_color_change(change: ColorChange, mark: str, sandbox: Sandbox) -> ColorProgram:
    program = write_color_program(
        _make_file_processor(change, sandbox)
        if isinstance(change, LookupFile)
        else _make_space_processor(change, get_color_manager(change.color, sandbox)),
        _UNNAMED,
    )
    return _name_by_content(program)


def _name_by_content(program: ColorProgram) -> ColorProgram:
    """The program under a name that tells it from all others, wherever its file lies and whenever it was written.

    Programs are part of what the key of a picture is made from.
    """
    digest = blake2b(program.text.body.encode(), digest_size=8)
    for table in program.tables:
        values = np.asarray(table.values)
        digest.update(f"{table.linear} {values.shape}".encode() + values.tobytes())
    name = f"recolor_{digest.hexdigest()}"
    tables = [
        LookupTable(table.sampler.replace(_UNNAMED, name), table.linear, table.values) for table in program.tables
    ]
    return ColorProgram(name, parse(f"OpenColorIO/{name}", program.text.body.replace(_UNNAMED, name)), tuple(tables))


def _make_space_processor(change: SpaceChange, manager: ColorManager) -> Any:
    def find_space(name: str) -> OcioColorSpace:
        space = manager.find(name)
        if space is None:
            raise UsageError(f"no color space is called '{name}'{manager.suggest_space(name)}")
        return space

    return manager.make_processor(find_space(change.source), find_space(change.target))


def _make_file_processor(change: LookupFile, sandbox: Sandbox) -> Any:
    api = load_ocio()
    if not Path(change.path).is_file():
        raise InputError(f"{change.path}: there is no such file: choose a table (.cube, .3dl, .clf, ...)")
    check_table(change.path, sandbox)
    config, files = api.Config.CreateRaw(), None
    if may_name_files(change.path, sandbox):
        files = make_sandboxed_files(sandbox)
        config.setConfigIOProxy(files)
    api.ClearAllCaches()  # changed files are read again; a config would keep the old ones
    direction = api.TRANSFORM_DIR_INVERSE if change.inverse else api.TRANSFORM_DIR_FORWARD
    try:
        with name_for_library(change.path) as name:
            return config.getProcessor(api.FileTransform(name, interpolation=api.INTERP_BEST, direction=direction))
    except ocio_errors() as error:
        if files is not None and files.faults:
            raise InputError(f"{change.path}: names a file that may not be read: {files.faults[-1]}") from error
        reason = describe_ocio_error(error)
        raise InputError(f"{change.path}: is no color table that can be read: {reason}") from error

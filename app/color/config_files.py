"""The files that a color config reads besides itself: with `--root` they must lie inside of the folder too."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..resources.sandbox import Sandbox


def find_config_fault(config: Any, sandbox: Sandbox) -> str:
    """Why a config may not be used, as the rest of a sentence about it; "" if it may be."""
    for table in _find_tables(config) if sandbox.root else ():
        if reason := sandbox.fault(table):
            return f"its table {table} {reason}"
    return ""


def _find_tables(config: Any) -> Iterator[str]:
    """The tables that its color spaces, looks, views and named transforms name, where they would be found."""
    import PyOpenColorIO

    api: Any = PyOpenColorIO
    both, context = (api.COLORSPACE_DIR_TO_REFERENCE, api.COLORSPACE_DIR_FROM_REFERENCE), config.getCurrentContext()
    spaces = config.getColorSpaces(api.SEARCH_REFERENCE_SPACE_ALL, api.COLORSPACE_ALL)
    named_transforms = config.getNamedTransforms(api.NAMEDTRANSFORM_ALL)
    ways = (api.TRANSFORM_DIR_FORWARD, api.TRANSFORM_DIR_INVERSE)
    views = (api.VIEWTRANSFORM_DIR_TO_REFERENCE, api.VIEWTRANSFORM_DIR_FROM_REFERENCE)
    transforms = [space.getTransform(way) for space in spaces for way in both]
    transforms += [look.getTransform() for look in config.getLooks()]
    transforms += [look.getInverseTransform() for look in config.getLooks()]
    transforms += [view.getTransform(way) for view in config.getViewTransforms() for way in views]
    transforms += [transform.getTransform(way) for transform in named_transforms for way in ways]
    for source in dict.fromkeys(source for one in transforms for source in _find_sources(api, one)):
        try:
            yield context.resolveFileLocation(source)
        except api.Exception:
            yield context.resolveStringVar(source)


def _find_sources(api: Any, transform: Any) -> Iterator[str]:
    """The names of files in a transform, groups looked into."""
    if isinstance(transform, api.FileTransform):
        yield transform.getSrc()
    elif isinstance(transform, api.GroupTransform):
        for part in transform:
            yield from _find_sources(api, part)

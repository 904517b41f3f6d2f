"""The files that a color config reads besides itself: with `--root` they must lie inside of the fence too."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

from ..resources.sandbox import ROOT, outside


def config_fault(config: Any) -> str:
    """Why a config may not be used, as the rest of a sentence about it; "" if it may be."""
    for table in _tables(config) if os.environ.get(ROOT) else ():
        if said := outside(table):
            return f"its table {table} {said}"
    return ""


def _tables(config: Any) -> Iterator[str]:
    """The tables that its color spaces, looks, views and named transforms name, where they would be found."""
    import PyOpenColorIO

    api: Any = PyOpenColorIO
    both, context = (api.COLORSPACE_DIR_TO_REFERENCE, api.COLORSPACE_DIR_FROM_REFERENCE), config.getCurrentContext()
    spaces = config.getColorSpaces(api.SEARCH_REFERENCE_SPACE_ALL, api.COLORSPACE_ALL)
    named = config.getNamedTransforms(api.NAMEDTRANSFORM_ALL)
    ways = (api.TRANSFORM_DIR_FORWARD, api.TRANSFORM_DIR_INVERSE)
    views = (api.VIEWTRANSFORM_DIR_TO_REFERENCE, api.VIEWTRANSFORM_DIR_FROM_REFERENCE)
    made = [space.getTransform(way) for space in spaces for way in both]
    made += [look.getTransform() for look in config.getLooks()]
    made += [look.getInverseTransform() for look in config.getLooks()]
    made += [view.getTransform(way) for view in config.getViewTransforms() for way in views]
    made += [one.getTransform(way) for one in named for way in ways]
    for source in dict.fromkeys(source for one in made for source in _sources(api, one)):
        try:
            yield context.resolveFileLocation(source)
        except api.Exception:
            yield context.resolveStringVar(source)


def _sources(api: Any, transform: Any) -> Iterator[str]:
    """The names of files in a transform, groups looked into."""
    if isinstance(transform, api.FileTransform):
        yield transform.getSrc()
    elif isinstance(transform, api.GroupTransform):
        for part in transform:
            yield from _sources(api, part)

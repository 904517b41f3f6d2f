"""The library of shaders for a working space."""

from __future__ import annotations

from ..resources.working_space import WorkingSpace
from .library import Library


def library_for(library: Library, working: WorkingSpace | None) -> Library:
    """The library for a working space; None is linear Rec.709, which it is written for."""
    return library if working is None else library.with_replacement(working.text, f"{working}")

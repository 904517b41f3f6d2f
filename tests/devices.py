"""The renderer that tests run on. HALATION_TEST_FORM=fragment gives it fragment passes, as on macOS."""

from __future__ import annotations

import ctypes
import gc
import os
from contextlib import suppress

from halation.compiler import Form
from halation.renderer import DEFAULT_BUDGET, Renderer, open_device
from halation.resources.machine import resident_memory
from halation.resources.sandbox import UNRESTRICTED


def form_to_test() -> Form | None:
    """The form of passes that the environment asks for; None leaves the choice to Halation."""
    form = os.environ.get("HALATION_TEST_FORM") or None
    assert form in ("fragment", "compute", None), f"HALATION_TEST_FORM={form}: fragment or compute"
    return form


GROWTH = 100 * 2**20
"""Bytes that a renderer may take in a process that is larger anyway."""

RENEWED = 520 * 2**20
"""Bytes of a process above which its renderer is replaced before the next file of tests. Mesa keeps all that it has
compiled: with one renderer for all nodes a worker grows to 960 MB. Less than this takes longer, as programs of
neighboring files are compiled again."""


class RendererKeeper:
    """Keeps one renderer open, and replaces it when the process has grown."""

    def __init__(self, budget: int) -> None:
        self._budget = budget
        self._renderer: Renderer | None = None
        self._base = 0

    def find_renderer(self) -> Renderer:
        """The renderer to use for the next tests."""
        if self._renderer is not None and resident_memory(os.getpid()) > max(RENEWED, self._base + GROWTH):
            self.close()
        if self._renderer is None:
            self._base = resident_memory(os.getpid())
            self._renderer = open_renderer(self._budget)
        return self._renderer

    def close(self) -> None:
        """Close the renderer, and hand what it took back to the system."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
            return_memory()


def return_memory() -> None:
    """Free what nothing refers to any more, and hand it back to the system.

    Windows, documents and renderers refer to each other, and Python seldom looks for garbage that is old: without this
    a worker keeps hundreds of megabytes of what has been closed.
    """
    gc.collect()
    with suppress(AttributeError, OSError, TypeError):  # of the C library of Linux only
        ctypes.CDLL(None).malloc_trim(0)


def open_renderer(budget: int = DEFAULT_BUDGET) -> Renderer:
    """A renderer on a device of its own, on whatever OpenGL this machine has; the caller closes it."""
    return Renderer(open_device(form_to_test(), sandbox=UNRESTRICTED), budget=budget, sandbox=UNRESTRICTED)

"""The renderer that tests run on. HALATION_TEST_FORM=fragment gives it fragment passes, as on macOS."""

from __future__ import annotations

import os

from halation.compiler import Form
from halation.renderer import DEFAULT_BUDGET, Renderer, open_device
from halation.resources.sandbox import UNRESTRICTED


def form_to_test() -> Form | None:
    """The form of passes that the environment asks for; None leaves the choice to Halation."""
    form = os.environ.get("HALATION_TEST_FORM") or None
    assert form in ("fragment", "compute", None), f"HALATION_TEST_FORM={form}: fragment or compute"
    return form


def open_renderer(budget: int = DEFAULT_BUDGET) -> Renderer:
    """A renderer on a device of its own, on whatever OpenGL this machine has; the caller closes it."""
    return Renderer(open_device(form_to_test(), sandbox=UNRESTRICTED), budget=budget, sandbox=UNRESTRICTED)

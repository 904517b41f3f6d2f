"""The libraries of the extra `fit`, which may be missing."""

from __future__ import annotations

import importlib.util
import warnings
from typing import Any

from ..errors import UsageError

HOW_TO_INSTALL = "fitting needs scipy and cma: run pip install 'halation[fit]'"


def load_fit_library(name: str) -> Any:
    """A library of the extra `fit`. Raises UsageError where it is not installed."""
    try:
        if name == "cma":
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # it says that it cannot draw diagrams
                import cma

            return cma
        from scipy import optimize
    except ImportError:
        raise UsageError(HOW_TO_INSTALL) from None
    return optimize


def check_fit_libraries() -> None:
    """Raise UsageError where a library of the extra `fit` is not installed."""
    load_fit_library("scipy")
    load_fit_library("cma")


def has_fit_libraries() -> bool:
    """Whether both are installed; nothing is imported for it."""
    return all(importlib.util.find_spec(name) is not None for name in ("scipy", "cma"))

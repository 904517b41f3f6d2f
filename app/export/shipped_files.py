"""Reads the texts that exports copy: readers, the page and its script."""

from __future__ import annotations

from importlib import resources


def read_shipped_text(name: str) -> str:
    """The text of a file in `assets`, which ships with Halation."""
    return (resources.files(__package__ or "") / "assets" / name).read_text("utf-8")

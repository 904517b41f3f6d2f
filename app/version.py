"""Which Halation this is, without asking the files that installers leave: that takes longer than to start."""

from __future__ import annotations

VERSION = "0.1.0"
"""The one place that says it; the packaging reads it here."""

"""Unsaved work is kept on disk, so that it survives a crash."""

from __future__ import annotations

from .recovery import RecoveredWork, RecoveryFile

__all__ = ["RecoveredWork", "RecoveryFile"]

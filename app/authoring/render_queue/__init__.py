"""Renders to files, one process each, which run beside the editor."""

from __future__ import annotations

from .queue import RenderQueue
from .queued_render import QueuedJob, QueuedRender, RenderState

__all__ = ["QueuedJob", "QueuedRender", "RenderQueue", "RenderState"]

"""Halation as a program of the desktop: its entry in the menu, its icon, the type of its files, their thumbnails."""

from .entries import desktop_entries
from .installation import install, remove
from .message import show_error

__all__ = ["desktop_entries", "install", "remove", "show_error"]

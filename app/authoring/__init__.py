"""Editing without a window: commands, history, selection, clipboard, recovery, preview scheduling."""

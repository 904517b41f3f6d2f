"""What goes on beside the window: preferences, recovery, watched files, renders to disk."""

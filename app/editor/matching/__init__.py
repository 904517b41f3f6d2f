"""The window that finds values which make the picture like a reference."""

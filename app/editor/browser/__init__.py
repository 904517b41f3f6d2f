"""The file browser: choosing a file without leaving the window."""

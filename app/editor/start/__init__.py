"""The start screen: presets, recent files, unsaved work."""

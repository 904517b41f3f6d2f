"""Widgets that all panels share. Everything that a person can press or read notes its place in `editor.places`."""

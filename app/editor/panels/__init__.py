"""Panels around the canvas, dialogs, and what is drawn over everything."""

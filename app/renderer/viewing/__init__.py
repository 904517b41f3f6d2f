"""Draws results on a screen, and reads their numbers back."""

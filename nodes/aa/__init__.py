"""Antialiasing."""

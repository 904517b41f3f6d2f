"""Mattes."""

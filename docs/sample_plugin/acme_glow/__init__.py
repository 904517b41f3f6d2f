"""Soft glows for Halation."""

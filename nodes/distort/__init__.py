"""Distort."""

"""Triangles of 3D scenes: those of mesh files, and those of the scenes that are built in."""

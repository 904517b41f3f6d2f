"""Triangles of 3D scenes: of mesh files, and of the built-in scenes."""

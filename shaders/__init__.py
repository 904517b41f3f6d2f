"""GLSL only."""

"""A pass becomes GLSL."""

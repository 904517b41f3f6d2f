"""Passes become a plan: their order, and which textures hold what, under which keys."""

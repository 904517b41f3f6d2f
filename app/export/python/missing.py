"""Why some nodes have no function for scripts: the sentence that a refusal ends with."""

from __future__ import annotations

_REASONS = {
    "its reference is Blender's picture or a closed form, not the same steps in numpy": (
        "ambient_occlusion", "depth_of_field", "directional_occlusion", "geometry_edges", "motion_blur",
    ),
    "it casts rays through the picture, and its reference casts them at the true surfaces": (
        "contact_shadows", "light_shafts", "screen_reflections",
    ),
    "it approaches integrals that its reference takes over all directions": ("image_based_light",),
    "OpenColorIO does the work": ("color_space", "lut_file"),
    "Open Image Denoise does the work": ("denoise",),
    "FreeType and HarfBuzz make its letters": ("text",),
    "it reads files inside of the graph, with a library: make them inputs": (
        "cryptomatte", "light_groups", "read_image", "read_render", "scene",
    ),
    "its outlines and strokes are no values that a script holds": ("paint", "roto", "spline_warp"),
    "it fills holes by pyramids, and its reference solves the equation itself, which is another picture": (
        "edge_extend", "inpaint", "screen_clean_plate",
    ),
    "its table was found by a long search": ("blue_noise",),
}  # fmt: skip
"""Nodes by the reason why they have no function."""


def explain_missing(id: str) -> str:
    """Why a node of the package has no function; empty for one that is not part of it."""
    return next((reason for reason, ids in _REASONS.items() if id in ids), "")


def list_explained() -> list[str]:
    """All nodes that have a reason."""
    return [id for ids in _REASONS.values() for id in ids]

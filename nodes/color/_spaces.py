"""Color spaces by the names that artists know, and what OpenColorIO's studio config calls them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

from .._declare import WORKING_SPACE

Space = Literal[
    "working",
    "linear rec709",
    "srgb",
    "gamma 2.2",
    "gamma 2.4",
    "rec709 camera",
    "linear p3",
    "display p3",
    "linear rec2020",
    "rec2100 pq",
    "rec2100 hlg",
    "linear adobergb",
    "adobergb",
    "acescg",
    "acescct",
    "acescc",
    "aces2065-1",
    "arri logc3",
    "arri logc4",
    "apple log",
    "blackmagic film",
    "canon log2",
    "canon log3",
    "davinci intermediate",
    "dji d-log",
    "panasonic v-log",
    "red log3g10",
    "sony s-log3",
    "sony s-log3 cine",
]

WORKING: Space = WORKING_SPACE
"""What pictures are in between nodes: linear Rec.709 unless the graph says otherwise."""

SPACES: Mapping[str, str] = MappingProxyType(
    {
        "linear rec709": "lin_rec709_scene",
        "srgb": "srgb_rec709_scene",
        "gamma 2.2": "g22_encoded_rec709",
        "gamma 2.4": "g24_encoded_rec709",
        "rec709 camera": "camera_rec709",
        "linear p3": "lin_p3d65_scene",
        "display p3": "srgb_encoded_p3d65",
        "linear rec2020": "lin_rec2020_scene",
        "rec2100 pq": "rec2100_pq_display",
        "rec2100 hlg": "rec2100_hlg_display",
        "linear adobergb": "lin_adobergb_scene",
        "adobergb": "g22_adobergb_scene",
        "acescg": "lin_ap1_scene",
        "acescct": "acescct_ap1",
        "acescc": "acescc_ap1",
        "aces2065-1": "aces2065_1",
        "arri logc3": "arri_logc3_ei800",
        "arri logc4": "arri_logc4",
        "apple log": "apple_log",
        "blackmagic film": "bmdfilm_widegamut_gen5",
        "canon log2": "canonlog2_cinemagamut_d55",
        "canon log3": "canonlog3_cinemagamut_d55",
        "davinci intermediate": "davinci_intermediate_widegamut",
        "dji d-log": "dlog_dgamut",
        "panasonic v-log": "vlog_vgamut",
        "red log3g10": "log3g10_redwidegamutrgb",
        "sony s-log3": "slog3_sgamut3",
        "sony s-log3 cine": "slog3_sgamut3cine",
    }
)


def name_space(space: Space) -> str:
    """What the library calls a space; the working space is whatever the graph says."""
    return SPACES.get(space, space)

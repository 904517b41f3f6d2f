"""The course: twelve short lessons about the techniques of screen-space effects, in their order.

Each has one idea, a graph of its own in `presets/lessons`, a task, the condition that the task asks for, and commands
that solve it. Numbers in the sentences were measured on these graphs, or name their source; tests measure them again.
"""

from __future__ import annotations

from .camera_lessons import DEPTH_OF_FIELD, EDGES_AND_CARTOONS, MOTION_BLUR, NOISE_AND_WARPS
from .filter_lessons import BLOOM_PYRAMID, BUFFERS, CONVOLUTION, SEPARABLE_BLUR
from .light_lessons import ADAPTATION, AMBIENT_OCCLUSION, DEFERRED_LIGHT, TONE_MAPPING

COURSE = (
    BUFFERS,
    CONVOLUTION,
    SEPARABLE_BLUR,
    BLOOM_PYRAMID,
    MOTION_BLUR,
    NOISE_AND_WARPS,
    TONE_MAPPING,
    ADAPTATION,
    DEFERRED_LIGHT,
    AMBIENT_OCCLUSION,
    DEPTH_OF_FIELD,
    EDGES_AND_CARTOONS,
)
"""All lessons."""

#include "lib/id_color.glsl"

float id_mask_none() { return 0.0; }

// Adds ids within ranges: from x to y, and from z to w.
float id_mask_add(float ids, float found, vec4 spans[8]) {
    for (int i = 0; i < 8; ++i) {
        if (ids >= spans[i].x && ids <= spans[i].y) found = 1.0;
        if (ids >= spans[i].z && ids <= spans[i].w) found = 1.0;
    }
    return found;
}

float id_mask(float found, bool invert) { return invert ? 1.0 - found : found; }

vec4 id_mask_colors(float ids) { return vec4(id_color(finite(ids)), 1.0); }

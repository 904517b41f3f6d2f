#include "lib/id_color.glsl"

float id_mask_none() { return 0.0; }

// Adds ids within ranges: from x to y, and from z to w.
float id_mask_add(float ids, float mask, vec4 spans[8]) {
    for (int i = 0; i < 8; ++i) {
        if (ids >= spans[i].x && ids <= spans[i].y) mask = 1.0;
        if (ids >= spans[i].z && ids <= spans[i].w) mask = 1.0;
    }
    return mask;
}

float id_mask(float matte, bool invert) { return invert ? 1.0 - matte : matte; }

vec4 id_mask_colors(float ids) { return vec4(id_color(finite(ids)), 1.0); }

#include "lib/display.glsl"

float fxaa_tone(vec4 image) { return display_tone(image); }

float fxaa_near(int x, int y) { return tone_at(pixel + ivec2(x, y)); }

// The length of each step of the search along an edge, in pixels: presets 12, 29 and 39 of FXAA 3.11 (Lottes 2011). 0
// ends the search.
float fxaa_stride(int quality, int i) {
    const float low[12] = float[](1.0, 1.5, 2.0, 4.0, 12.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    const float medium[12] = float[](1.0, 1.5, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 4.0, 8.0);
    const float high[12] = float[](1.0, 1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.0, 2.0, 4.0, 8.0);
    return quality == QUALITY_LOW ? low[i] : quality == QUALITY_MEDIUM ? medium[i] : high[i];
}

// Where the search along the edge ends: the distance, and the difference between the tone there and the tone of the
// edge.
vec2 fxaa_end(vec2 from, vec2 along, float edge_tone, float enough, int quality) {
    float away = fxaa_stride(quality, 0), differs = 0.0;
    for (int i = 1; i < 12 && fxaa_stride(quality, i) > 0.0; ++i) {
        differs = tone_near(from + away * along) - edge_tone;
        if (abs(differs) >= enough) break;
        away += fxaa_stride(quality, i);  // after the last step, which is the longest, nothing is read
    }
    return vec2(away, differs);
}

vec4 fxaa(int quality, float subpixel, float threshold, float threshold_dark) {
    float here = fxaa_near(0, 0), north = fxaa_near(0, -1), south = fxaa_near(0, 1);
    float west = fxaa_near(-1, 0), east = fxaa_near(1, 0);
    float high = max(max(max(north, south), max(west, east)), here);
    float contrast = high - min(min(min(north, south), min(west, east)), here);
    if (contrast < max(threshold_dark, high * threshold) || contrast == 0.0) return image_at(pixel);

    float north_west = fxaa_near(-1, -1), north_east = fxaa_near(1, -1);
    float south_west = fxaa_near(-1, 1), south_east = fxaa_near(1, 1);
    float across_rows = abs(north_west + south_west - 2.0 * west) + 2.0 * abs(north + south - 2.0 * here)
                      + abs(north_east + south_east - 2.0 * east);
    float across_columns = abs(north_west + north_east - 2.0 * north) + 2.0 * abs(west + east - 2.0 * here)
                         + abs(south_west + south_east - 2.0 * south);
    // In a pixel that sticks out both are the same sum: rows win, whichever way a driver rounds it.
    bool level = across_rows >= across_columns - 1e-5 * high;

    // The edge runs between this pixel and the neighbor whose tone differs most.
    float before = level ? north : west, after = level ? south : east;
    bool is_before = abs(before - here) >= abs(after - here);
    vec2 along = level ? vec2(1.0, 0.0) : vec2(0.0, 1.0), toward = (is_before ? -1.0 : 1.0) * along.yx;
    float edge_tone = 0.5 * (here + (is_before ? before : after));
    float enough = 0.25 * max(abs(before - here), abs(after - here));
    vec2 center = vec2(pixel) + 0.5, on_edge = center + 0.5 * toward;
    vec2 left = fxaa_end(on_edge, -along, edge_tone, enough, quality);
    vec2 right = fxaa_end(on_edge, along, edge_tone, enough, quality);

    // The pixel is shifted only if the edge cuts into this pixel at its nearer end.
    vec2 end = left.x < right.x ? left : right;
    bool cuts = (end.y < 0.0) != (here - edge_tone < 0.0);
    float shift = cuts ? 0.5 - end.x / (left.x + right.x) : 0.0;

    float mean = (2.0 * (north + south + west + east) + north_west + north_east + south_west + south_east) / 12.0;
    float lonely = smoothstep(0.0, 1.0, abs(mean - here) / contrast);
    shift = max(shift, lonely * lonely * subpixel);
    return image_near(center + shift * toward);
}

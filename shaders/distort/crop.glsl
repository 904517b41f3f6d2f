// `start` is the pixel of the image that the first pixel of the result shows; `box` is left, top, right, bottom.
vec4 crop(vec2 start, vec4 box, float softness) {
    ivec2 source = pixel + ivec2(start);
    vec2 at = vec2(source) + 0.5;
    vec2 within = min(at - box.xy, box.zw - at);
    if (min(within.x, within.y) <= 0.0) return vec4(0.0);
    vec2 faded = clamp(within / max(softness, 1e-6), 0.0, 1.0);
    return image_at(source) * (softness > 0.0 ? faded.x * faded.y : 1.0);
}

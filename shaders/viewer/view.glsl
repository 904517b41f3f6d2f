#include "lib/color.glsl"

uniform int channels;
uniform float exposure, gamma;

// The channel that the viewer shows, or all.
vec3 chosen(vec4 c) {
    if (channels >= RED && channels <= ALPHA) return vec3(c[channels - RED]);
    return channels == LUMINANCE ? vec3(luminance(c.rgb)) : c.rgb;
}

// The divisor for straight color. Color without alpha, such as a glow, stays as bright as it is.
float straightness(vec4 c) { return channels == COLOR && c.a > 0.0 ? c.a : 1.0; }

#if !DATA && !VIEWED
// A view costs more than everything else, so it is called in one place.
vec3 seen(vec4 c) {
    vec3 linear = clamp(chosen(c) / straightness(c), -65504.0, 65504.0);
    vec3 shown = view_transform(vec4(linear, 1.0)).rgb;
    return gamma == 1.0 ? shown : pow(max(shown, 0.0), vec3(1.0 / gamma));
}
#endif

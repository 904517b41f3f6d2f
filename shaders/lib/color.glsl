// Color science of the working space, which is scene-linear.
#include "lib/working.glsl"

// The luminance of a color in the working space.
float luminance(vec3 rgb) { return dot(rgb, LUMINANCE_WEIGHTS); }

// The largest channel.
float largest(vec3 v) { return max(max(v.r, v.g), v.b); }
// The smallest channel.
float smallest(vec3 v) { return min(min(v.r, v.g), v.b); }

// The sRGB curve (IEC 61966-2-1). Negative light is mirrored, so that encoding and decoding are inverse for all
// numbers.
float srgb_encode(float linear) {
    float light = abs(linear);
    return sign(linear) * (light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1.0 / 2.4) - 0.055);
}

// The light of an sRGB code: the inverse of srgb_encode().
float srgb_decode(float encoded) {
    float code = abs(encoded);
    return sign(encoded) * (code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4));
}

vec3 srgb_encode(vec3 rgb) { return vec3(srgb_encode(rgb.r), srgb_encode(rgb.g), srgb_encode(rgb.b)); }
vec3 srgb_decode(vec3 rgb) { return vec3(srgb_decode(rgb.r), srgb_decode(rgb.g), srgb_decode(rgb.b)); }

// Hue as a fraction of a turn: red 0, green 1/3, blue 2/3. Grays have hue 0.
float hue(vec3 rgb) {
    float high = largest(rgb), spread = high - smallest(rgb);
    if (spread <= 0.0) return 0.0;
    if (high == rgb.r) return fract((rgb.g - rgb.b) / spread / 6.0);
    return (high == rgb.g ? 2.0 + (rgb.b - rgb.r) / spread : 4.0 + (rgb.r - rgb.g) / spread) / 6.0;
}

// The color with another hue; its largest and smallest channel stay.
vec3 with_hue(vec3 rgb, float turn) {
    vec3 share = clamp(abs(fract(turn + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
    return mix(vec3(smallest(rgb)), vec3(largest(rgb)), share);
}

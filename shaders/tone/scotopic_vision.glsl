#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// Rec.709 to CIE XYZ (ITU-R BT.709-6), written by rows and multiplied from the left.
const mat3 SCOTOPIC_VISION_XYZ = mat3(
    0.41239080, 0.35758434, 0.18048079, 0.21263901, 0.71516868, 0.07219232, 0.01933082, 0.11919478, 0.95053215
);

// The response of the rods to a color (Ward Larson et al. 1997), relative to white.
float scotopic_vision_rods(vec3 rgb) {
    const float white = 1.33 * (1.0 + (1.0 + 1.08905775) / 0.95045593) - 1.68;
    vec3 xyz = max(to_rec709(rgb), 0.0) * SCOTOPIC_VISION_XYZ;
    return max(xyz.y * (1.33 * (1.0 + (xyz.y + xyz.z) / max(xyz.x, 1e-30)) - 1.68), 0.0) / white;
}

// The luminance in cd/m2 to which the eye adapts at a pixel.
float scotopic_vision_light(vec4 image, float adaptation, bool local, float nits) {
    float scene = local ? luminance(max(straight(finite(image)).rgb, 0.0)) : finite(adaptation);
    return clamp(scene * nits, 0.0, 1e9);
}

vec4 scotopic_vision(vec4 image, float light, float amount, float blue_shift, float brightness) {
    const vec3 night = vec3(1.05, 0.97, 1.27);  // color of night vision (Krawczyk et al. 2005)
    vec4 color = straight(finite(image));
    float share = amount * 0.04 / (0.04 + light);
    vec3 tint = max(1.0 + blue_shift * (night - 1.0), 0.0);
    vec3 rods = brightness * scotopic_vision_rods(min(color.rgb, 1e9)) * tint;
    return finite(premultiplied(vec4((1.0 - share) * color.rgb + share * rods, color.a)));
}

// The blur of the eye as sigma in pixels (Ward Larson et al. 1997), minus that of daylight, which the viewer's own eye
// adds.
float scotopic_vision_sigma(float light, float scale) {
    const float bright = 17.25 * 1.57079633 + 25.72, dim = 2.0;
    float decades = log(max(light, 1e-9)) / log(10.0);
    float finest = clamp(17.25 * atan(1.4 * decades + 0.35) + 25.72, dim, bright);
    return scale * sqrt(max(1.0 / (finest * finest) - 1.0 / (bright * bright), 0.0));
}

// Interpolates between two blurs by variance, which mixes linearly; sigma does not.
vec4 scotopic_vision_blur(vec4 sharp, vec4 soft, float sigma, float low, float high) {
    float share = clamp((sigma * sigma - low * low) / (high * high - low * low), 0.0, 1.0);
    return (1.0 - share) * sharp + share * soft;
}

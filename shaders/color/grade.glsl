#include "lib/alpha.glsl"
#include "lib/finite.glsl"

float grade_gamma(float light, float gamma) { return light > 0.0 ? pow(light, 1.0 / max(gamma, 1e-3)) : light; }

vec4 grade(vec4 image, vec4 lift, vec4 gamma, vec4 gain, vec4 offset, float amount) {
    image = finite(image), lift = finite(lift), gamma = finite(gamma), gain = finite(gain), offset = finite(offset);
    // Lift, gain and offset work on premultiplied color, so that transparent pixels stay black.
    vec3 lifted = image.rgb * (gain.rgb - lift.rgb) + image.a * (lift.rgb + offset.rgb);
    vec4 graded = straight(vec4(lifted, image.a));
    graded.r = grade_gamma(graded.r, gamma.r);
    graded.g = grade_gamma(graded.g, gamma.g);
    graded.b = grade_gamma(graded.b, gamma.b);
    return finite(mix(image, premultiplied(graded), finite(amount)));
}

#include "lib/alpha.glsl"
#include "lib/finite.glsl"

vec4 set_matte(vec4 image, float matte, int operation, int color, bool invert) {
    vec4 c = finite(image);
    float m = clamp(finite(matte), 0.0, 1.0);
    if (invert) m = 1.0 - m;
    float alpha = m;
    if (operation == OPERATION_MULTIPLY) alpha = c.a * m;
    if (operation == OPERATION_MAXIMUM) alpha = max(c.a, m);
    if (operation == OPERATION_SUBTRACT) alpha = c.a * (1.0 - m);
    vec3 light = color == COLOR_STRAIGHT ? c.rgb : straight(c).rgb;
    return vec4(light * alpha, alpha);
}

#include "lib/finite.glsl"

vec3 vector_math_divide(vec3 a, vec3 b) {
    return vec3(b.x == 0.0 ? 0.0 : a.x / b.x, b.y == 0.0 ? 0.0 : a.y / b.y, b.z == 0.0 ? 0.0 : a.z / b.z);
}

// The part of `a` along `b`.
vec3 vector_math_project(vec3 a, vec3 b) {
    float square = dot(b, b);
    return square == 0.0 ? vec3(0.0) : b * (dot(a, b) / square);
}

void vector_math(
    vec3 a, int operation, vec3 b, vec3 c, float factor, out vec3 result, out float product, out float extent_of
) {
    vec3 u = finite(a), v = finite(b), w = finite(c), r = u + v;
    if (operation == OPERATION_SUBTRACT) r = u - v;
    if (operation == OPERATION_MULTIPLY) r = u * v;
    if (operation == OPERATION_DIVIDE) r = vector_math_divide(u, v);
    if (operation == OPERATION_MULTIPLY_ADD) r = u * v + w;
    if (operation == OPERATION_CROSS) r = cross(u, v);
    if (operation == OPERATION_PROJECT) r = vector_math_project(u, v);
    if (operation == OPERATION_REFLECT) r = u - 2.0 * vector_math_project(u, v);
    if (operation == OPERATION_SCALE) r = u * finite(factor);
    if (operation == OPERATION_NORMALIZE) {
        float size = length(u);
        r = size == 0.0 ? vec3(0.0) : u / size;
    }
    if (operation == OPERATION_ABSOLUTE) r = abs(u);
    if (operation == OPERATION_MINIMUM) r = min(u, v);
    if (operation == OPERATION_MAXIMUM) r = max(u, v);
    if (operation == OPERATION_FLOOR) r = floor(u);
    if (operation == OPERATION_FRACTION) r = u - floor(u);
    result = finite(r);
    product = finite(dot(u, v));
    extent_of = finite(length(result));
}

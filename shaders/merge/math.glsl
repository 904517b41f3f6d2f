#include "lib/finite.glsl"

float math_power(float a, float b) {
    if (b == 0.0) return 1.0;
    return a > 0.0 ? pow(a, b) : 0.0;
}

float math(float a, int operation, float b, float c) {
    a = finite(a), b = finite(b), c = finite(c);
    float result = a;
    if (operation == OPERATION_ADD) result = a + b;
    if (operation == OPERATION_SUBTRACT) result = a - b;
    if (operation == OPERATION_MULTIPLY) result = a * b;
    if (operation == OPERATION_DIVIDE) result = b != 0.0 ? a / b : 0.0;
    if (operation == OPERATION_MULTIPLY_ADD) result = a * b + c;
    if (operation == OPERATION_POWER) result = math_power(a, b);
    if (operation == OPERATION_MINIMUM) result = min(a, b);
    if (operation == OPERATION_MAXIMUM) result = max(a, b);
    if (operation == OPERATION_MODULO) result = b != 0.0 ? a - b * floor(a / b) : 0.0;
    if (operation == OPERATION_GREATER) result = a > b ? 1.0 : 0.0;
    if (operation == OPERATION_LESS) result = a < b ? 1.0 : 0.0;
    if (operation == OPERATION_ABSOLUTE) result = abs(a);
    if (operation == OPERATION_NEGATE) result = -a;
    if (operation == OPERATION_SIGN) result = sign(a);
    if (operation == OPERATION_FLOOR) result = floor(a);
    if (operation == OPERATION_CEILING) result = ceil(a);
    if (operation == OPERATION_ROUND) result = floor(a + 0.5);
    if (operation == OPERATION_FRACTION) result = fract(a);
    if (operation == OPERATION_SQUARE_ROOT) result = sqrt(max(a, 0.0));
    if (operation == OPERATION_EXPONENTIAL) result = exp(min(a, 88.0));  // the largest that a float holds
    if (operation == OPERATION_LOGARITHM) result = a > 0.0 ? log(a) : 0.0;
    if (operation == OPERATION_SINE) result = sin(a);
    if (operation == OPERATION_COSINE) result = cos(a);
    if (operation == OPERATION_ARC_TANGENT) result = a == 0.0 && b == 0.0 ? 0.0 : atan(a, b);
    if (operation == OPERATION_CLAMP) result = max(min(a, c), b);
    if (operation == OPERATION_REMAP) result = c != b ? (a - b) / (c - b) : 0.0;
    if (operation == OPERATION_SMOOTHSTEP) {
        float t = c != b ? clamp((a - b) / (c - b), 0.0, 1.0) : step(b, a);
        result = t * t * (3.0 - 2.0 * t);
    }
    if (operation == OPERATION_MIX) result = mix(a, b, c);
    return finite(result);
}

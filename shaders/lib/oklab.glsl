// OKLab (Ottosson 2020): lightness, red-green and yellow-blue, perceptually uniform. Light times k is all three times
// the cube root of k, so premultiplied color can be rotated and saturated directly.
#include "lib/working.glsl"

// The cube root, also of negative numbers.
float signed_cbrt(float x) { return sign(x) * pow(abs(x), 1.0 / 3.0); }

// OKLab of a color. Matrices are written by rows and multiplied from the left.
vec3 to_oklab(vec3 rgb) {
    vec3 cones = to_rec709(rgb) * mat3(
        0.4122214708, 0.5363325363, 0.0514459929,
        0.2119034982, 0.6806995451, 0.1073969566,
        0.0883024619, 0.2817188376, 0.6299787005
    );
    return vec3(signed_cbrt(cones.x), signed_cbrt(cones.y), signed_cbrt(cones.z)) * mat3(
        0.2104542553, 0.7936177850, -0.0040720468,
        1.9779984951, -2.4285922050, 0.4505937099,
        0.0259040371, 0.7827717662, -0.8086757660
    );
}

// The inverse of to_oklab().
vec3 from_oklab(vec3 lab) {
    vec3 root = lab * mat3(
        1.0, 0.3963377774, 0.2158037573,
        1.0, -0.1055613458, -0.0638541728,
        1.0, -0.0894841775, -1.2914855480
    );
    return from_rec709(root * root * root * mat3(
        4.0767416621, -3.3077115913, 0.2309699292,
        -1.2684380046, 2.6097574011, -0.3413193965,
        -0.0041960863, -0.7034186147, 1.7076147010
    ));
}

#include "lib/finite.glsl"
#include "lib/working.glsl"

const float white_balance_daylight = 6504.0;  // correlated color temperature of D65, in kelvin
const float white_balance_offset = 0.0032647;  // distance of D65 from the Planckian locus in CIE 1960 uv (Duv)
const float white_balance_unit = 1.0 / 3000.0;  // Duv of one step of tint, as in Adobe Camera Raw
const float white_balance_darkest = 0.02;  // least response of a cone: darker light cannot be balanced to white

// Matrices are written by rows and multiplied from the left. Rec.709 with D65 to XYZ: IEC 61966-2-1. Bradford: Lam
// 1985. CAT16: Li et al. 2017.
const mat3 WHITE_BALANCE_XYZ = mat3(
    0.4124564, 0.3575761, 0.1804375,
    0.2126729, 0.7151522, 0.0721750,
    0.0193339, 0.1191920, 0.9503041
);
const mat3 WHITE_BALANCE_BRADFORD = mat3(
    0.8951, 0.2664, -0.1614,
    -0.7502, 1.7135, 0.0367,
    0.0389, -0.0685, 1.0296
);
const mat3 WHITE_BALANCE_CAT16 = mat3(
    0.401288, 0.650173, -0.051461,
    -0.250268, 1.204414, 0.045854,
    -0.002079, 0.048952, 0.953127
);

// The response of the cones to light of luminance 1, of a black body that `tint` moves toward green or magenta. Black
// bodies in CIE 1960 uv are quotients of two polynomials, accurate to 8e-5 from 1000 K to 15000 K (Krystek 1985). The
// normal of that curve points to green.
vec3 white_balance_cones(float kelvin, float tint, mat3 to_cones) {
    vec3 powers = vec3(1.0, kelvin, kelvin * kelvin), rising = vec3(0.0, 1.0, 2.0 * kelvin);
    mat2x3 over = mat2x3(0.860117757, 1.54118254e-4, 1.28641212e-7, 0.317398726, 4.22806245e-5, 4.20481691e-8);
    mat2x3 under = mat2x3(1.0, 8.42420235e-4, 7.08145163e-7, 1.0, -2.89741816e-5, 1.61456053e-7);
    vec2 planck = (powers * over) / (powers * under);
    vec2 along = (rising * over - planck * (rising * under)) / (powers * under);
    vec2 greener = normalize(vec2(along.y, -along.x) * sign(-along.x));
    vec2 uv = planck + greener * (white_balance_offset + tint * white_balance_unit);
    vec2 xy = vec2(3.0 * uv.x, 2.0 * uv.y) / (2.0 * uv.x - 8.0 * uv.y + 4.0);
    return vec3(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y) * to_cones;
}

vec4 white_balance(vec4 image, float temperature, float tint, int method) {
    image = finite(image);
    mat3 to_cones = method == METHOD_CAT16 ? WHITE_BALANCE_CAT16 : WHITE_BALANCE_BRADFORD;
    temperature = clamp(finite(temperature), 1667.0, 15000.0), tint = clamp(finite(tint), -100.0, 100.0);
    vec3 lit = max(white_balance_cones(temperature, tint, to_cones), white_balance_darkest);
    vec3 white = white_balance_cones(white_balance_daylight, 0.0, to_cones);
    mat3 from_rgb = WHITE_BALANCE_XYZ * to_cones;
    return finite(vec4(from_rec709((to_rec709(image.rgb) * from_rgb) * (white / lit) * inverse(from_rgb)), image.a));
}

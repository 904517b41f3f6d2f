// Reflection of light at surfaces. Vectors have length 1: n is the normal, h is halfway between the directions to the
// eye and to the light. nv, nl and vh are cosines between them; alpha is the square of the roughness.
#include "lib/pi.glsl"

// Fresnel reflectance (Schlick 1994).
vec3 fresnel(vec3 f0, float vh) {
    float x = clamp(1.0 - vh, 0.0, 1.0), x2 = x * x;
    return f0 + (1.0 - f0) * (x2 * x2 * x);
}

// The GGX distribution of microfacets that face h (Walter et al. 2007). 1 - (n.h)^2 is computed as |n x h|^2, which
// loses no digits.
float ggx_facets(vec3 n, vec3 h, float alpha) {
    vec3 off = cross(n, h);
    float along = alpha * dot(n, h), size = along * along + dot(off, off);
    return alpha * alpha / (PI * size * size);
}

// The share of visible and lit microfacets, divided by 4 nv nl: Smith's height-correlated term (Heitz 2014).
float ggx_visible(float nv, float nl, float alpha) {
    vec2 c = vec2(nv, nl), far = sqrt(c * c * (1.0 - alpha * alpha) + alpha * alpha);
    return 0.5 / (nl * far.x + nv * far.y);
}

// The reflection of a uniform sky by the microfacets: MaterialX's fit of the integral, within 0.03 except for polished
// surfaces at grazing angles.
vec3 ggx_sky(vec3 f0, float nv, float alpha) {
    float x = nv, y = alpha, x2 = x * x, y2 = y * y;
    vec4 r = vec4(0.1003, 0.9345, 1.0, 1.0)
        + vec4(-0.6303, -2.323, -1.765, 0.2281) * x + vec4(9.748, 2.229, 8.263, 15.94) * y
        + vec4(-2.038, -3.748, 11.53, -55.83) * x * y
        + vec4(29.34, 1.424, 28.96, 13.08) * x2 + vec4(-8.245, -0.7684, -7.507, 41.26) * y2
        + vec4(-26.44, 1.436, -36.11, 54.9) * x2 * y + vec4(19.99, 0.2913, 15.86, 300.2) * x * y2
        + vec4(-5.448, 0.6286, 33.37, -285.1) * x2 * y2;
    vec2 parts = clamp(r.xy / r.zw, 0.0, 1.0);
    return f0 * parts.x + parts.y;
}

// Phong's lobe around the mirrored view direction, scaled to conserve energy (Lafortune and Willems 1994). For a small
// alpha it is as wide as the GGX lobe; at alpha 1 its exponent is 1.
float phong_lobe(float rl, float alpha) {
    float power = 0.5 / (alpha * alpha) + 0.5;
    return (power + 2.0) / (2.0 * PI) * pow(max(rl, 1e-9), power);
}

// The light that a spherical lamp throws on a surface, relative to a point lamp straight above: the cosine, except
// where the horizon cuts the sphere (Snyder 1996, as in Lagarde and de Rousiers 2014). `square` is the squared sine of
// its angular radius.
float ball_cosine(float cosine, float square) {
    if (cosine * cosine >= square) return max(cosine, 0.0);
    float x = sqrt(1.0 / square - 1.0), sine = sqrt(1.0 - cosine * cosine), y = clamp(-x * cosine / sine, -1.0, 1.0);
    float t = sine * sqrt(1.0 - y * y) / x, t2 = t * t;
    // t - atan(t), as a series where the difference would lose digits.
    float rest = t < 0.25 ? t * t2 * (1.0 / 3.0 - t2 * (0.2 - t2 * (1.0 / 7.0 - t2 * (1.0 / 9.0 - t2 / 11.0)))) : t - atan(t);
    return max((cosine * acos(y) + t - rest / square) / PI, 0.0);
}

#include "lib/finite.glsl"

const float variable_blur_step = 1.587401;  // 2^(2/3): how many times the variance of the next finer rung

// The part of a Gaussian beyond x, on both sides (Abramowitz and Stegun 1964, 7.1.26).
float variable_blur_beyond(float x) {
    x *= sqrt(0.5);
    float t = 1.0 / (1.0 + 0.3275911 * x);
    float fit = 0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)));
    return t * fit * exp(-x * x);
}

// Of a blur's weights: below one pixel, the Gaussian is integrated over each.
float variable_blur_variance(float sigma) {
    if (sigma >= 1.0) return sigma * sigma;
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += float(2 * i + 1) * variable_blur_beyond((float(i) + 0.5) / sigma);
    return sum;
}

// Where a pixel stands on the ladder: 0 is the whole sigma, `last` the finest blur, and the picture itself follows.
float variable_blur_rung(float field, float sigma, float full, int last) {
    float amount = finite(field);
    if (amount <= 0.0) return float(last + 1);
    if (amount >= 1.0) return 0.0;
    float variance = variable_blur_variance(amount * sigma), finest = full * pow(variable_blur_step, float(-last));
    if (variance < finest) return float(last + 1) - variance / finest;
    return clamp(log2(full / variance) / log2(variable_blur_step), 0.0, float(last));
}

// The weights of a rung and the two next finer ones. Two would do for the variance; how much to add of what keeps both
// sum and variance, so that the shape comes nearest to a Gaussian, is by least squares in the plane.
vec3 variable_blur_weights(float t, bool shaped) {
    const float ratio = 1.0 / variable_blur_step, nearest = 0.5355;
    float share = (1.0 - pow(ratio, t)) / (1.0 - ratio);
    vec3 two = vec3(1.0 - share, share, 0.0);
    return shaped ? two - nearest * t * (1.0 - t) * vec3(ratio, -1.0 - ratio, 1.0) : two;
}

vec4 variable_blur_sharp(vec4 image, float at, int last) {
    return max(at - float(last), 0.0) * finite(image);
}

// Adds a rung. The finest two, and the finest and the picture, are so near that two will do.
vec4 variable_blur(vec4 sum, vec4 soft, float at, int rung, int last) {
    int above = min(int(at), last), away = rung - above;
    if (away < 0 || away > 2) return sum;
    float t = at - float(above);
    return sum + (above == last ? 1.0 - t : variable_blur_weights(t, above < last - 1)[away]) * soft;
}

#include "lib/finite.glsl"

const float variable_blur_step = 1.587401;  // 2^(2/3): the variance of a blur divided by that of the next finer one

// The part of a normal distribution outside of -x..x (Abramowitz and Stegun 1964, 7.1.26).
float variable_blur_beyond(float x) {
    x *= sqrt(0.5);
    float t = 1.0 / (1.0 + 0.3275911 * x);
    float fit = 0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)));
    return t * fit * exp(-x * x);
}

// The variance of the weights of a blur. Below one pixel they are the Gaussian integrated over each pixel, which is not
// sigma squared.
float variable_blur_variance(float sigma) {
    if (sigma >= 1.0) return sigma * sigma;
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += float(2 * i + 1) * variable_blur_beyond((float(i) + 0.5) / sigma);
    return sum;
}

// The position of a pixel on the ladder of blurs: 0 is the full sigma, `last` the finest blur, `last` + 1 the picture
// itself.
float variable_blur_rung(float field, float sigma, float full, int last) {
    float amount = finite(field);
    if (amount <= 0.0) return float(last + 1);
    if (amount >= 1.0) return 0.0;
    float variance = variable_blur_variance(amount * sigma), finest = full * pow(variable_blur_step, float(-last));
    if (variance < finest) return float(last + 1) - variance / finest;
    return clamp(log2(full / variance) / log2(variable_blur_step), 0.0, float(last));
}

// The weights of a blur and of the two next finer ones. Two blurs can give the wanted variance; the third makes the
// shape of the mixture closest to a Gaussian. 0.5355 is the amount with the least squared error over the plane.
vec3 variable_blur_weights(float t, bool shaped) {
    const float ratio = 1.0 / variable_blur_step, nearest = 0.5355;
    float share = (1.0 - pow(ratio, t)) / (1.0 - ratio);
    vec3 two = vec3(1.0 - share, share, 0.0);
    return shaped ? two - nearest * t * (1.0 - t) * vec3(ratio, -1.0 - ratio, 1.0) : two;
}

vec4 variable_blur_sharp(vec4 image, float at, int last) {
    return max(at - float(last), 0.0) * finite(image);
}

// Adds a blur of the ladder. Between the two finest blurs, and between the finest and the picture, two weights are
// accurate enough.
vec4 variable_blur(vec4 sum, vec4 soft, float at, int rung, int last) {
    int above = min(int(at), last), away = rung - above;
    if (away < 0 || away > 2) return sum;
    float t = at - float(above);
    return sum + (above == last ? 1.0 - t : variable_blur_weights(t, above < last - 1)[away]) * soft;
}

#include "lib/display.glsl"
#include "lib/structure.glsl"

const float difference_of_gaussians_reach = 3.0;    // in sigmas: 99.7 % of a Gaussian lie within
const float difference_of_gaussians_samples = 64.0; // most samples to either side; for wider blurs they spread

float difference_of_gaussians_tone(vec4 image) { return display_tone(image); }

// The structure tensor of the Sobel gradient, which is scaled so that a step of 1 along a row or column gives 1.
vec3 difference_of_gaussians_changes() {
    float falling = tone_at(pixel + ivec2(1, 1)) - tone_at(pixel - ivec2(1, 1));
    float rising = tone_at(pixel + ivec2(1, -1)) - tone_at(pixel + ivec2(-1, 1));
    return structure_tensor(vec2(
        2.0 * (tone_at(pixel + ivec2(1, 0)) - tone_at(pixel - ivec2(1, 0))) + falling + rising,
        2.0 * (tone_at(pixel + ivec2(0, 1)) - tone_at(pixel - ivec2(0, 1))) + falling - rising
    ) / 4.0);
}

// Both blurs in one pass, along the direction of most change (flow-based DoG, Kyprianidis and Döllner 2008).
vec2 difference_of_gaussians_across(float sigma, float ratio) {
    vec2 sigmas = max(sigma * vec2(1.0, ratio), 1e-3), across = structure_across(tensor_at(pixel));
    float reach = difference_of_gaussians_reach * sigmas.y, apart = max(1.0, reach / difference_of_gaussians_samples);
    vec2 center = vec2(pixel) + 0.5, sum = vec2(tone_at(pixel)), total = vec2(1.0);
    for (int i = 1; i <= int(reach / apart + 0.5); ++i) {
        float away = float(i) * apart;
        vec2 weight = exp(-0.5 * away * away / (sigmas * sigmas));
        sum += weight * (tone_near(center + away * across) + tone_near(center - away * across));
        total += 2.0 * weight;
    }
    return sum / total;
}

// The direction of the line at a place, with the sign that continues `before`; `before` itself where the tensor has no
// direction.
vec2 difference_of_gaussians_onward(vec2 at, vec2 before) {
    vec2 across = structure_across(tensor_near(at)), along = vec2(-across.y, across.x);
    if (across == vec2(0.0)) return before;
    return dot(along, before) < 0.0 ? -along : along;
}

// Averages along the line to both sides (line integral convolution). Each step uses the direction in its middle
// (midpoint method).
vec2 difference_of_gaussians_along(float stroke) {
    float reach = difference_of_gaussians_reach * stroke, apart = max(1.0, reach / difference_of_gaussians_samples);
    vec2 across = structure_across(tensor_at(pixel)), sum = blurs_at(pixel);
    float total = 1.0;
    for (int side = -1; side <= 1; side += 2) {
        vec2 at = vec2(pixel) + 0.5, way = float(side) * vec2(-across.y, across.x);
        for (int i = 1; i <= int(reach / apart + 0.5); ++i) {
            way = difference_of_gaussians_onward(at + 0.5 * apart * way, way);
            at += apart * way;
            float away = float(i) * apart / stroke, weight = exp(-0.5 * away * away);
            sum += weight * blurs_near(at);
            total += weight;
        }
    }
    return sum / total;
}

float difference_of_gaussians_fine(vec2 blurs) { return blurs.x; }
float difference_of_gaussians_coarse(vec2 blurs) { return blurs.y; }

float difference_of_gaussians_value(float fine, float coarse, int kind, float strength, float epsilon, float phi) {
    if (kind == KIND_DOG) return finite(strength * (fine - coarse));
    float sharp = (1.0 + strength) * fine - strength * coarse;
    return sharp >= epsilon ? 1.0 : 1.0 + tanh(max(phi * (sharp - epsilon), -20.0));
}

// XDoG (Winnemöller et al. 2012) gives a display tone, which is converted to light; a difference is neither.
vec4 difference_of_gaussians(vec4 image, float value, int kind) {
    float alpha = finite(image.a);
    return vec4(vec3(kind == KIND_XDOG ? srgb_decode(value) : value) * alpha, alpha);
}

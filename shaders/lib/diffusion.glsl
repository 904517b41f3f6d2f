// Fills unknown pixels by diffusion from those around them: the solution of Laplace's equation, which is the shape of a
// stretched membrane. `known` is 1 for pixels that stay and else 0. Nothing flows over the border of the picture.
#include "lib/finite.glsl"

// Half the size, from `picture` and `known`: the mean of the known pixels.
void diffusion_halve(out vec4 color, out float sure) {
    vec4 sum = vec4(0.0);
    float count = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = 2 * pixel + ivec2(i & 1, i >> 1);
        float weight = inside(at, picture_size) && known_at(at) > 0.5 ? 1.0 : 0.0;
        sum += weight * picture_at(at);
        count += weight;
    }
    color = sum / max(count, 1.0);
    sure = min(count, 1.0);
}

// The first guess, from `picture`, `known` and the solution `coarse` at half the size.
vec4 diffusion_start() {
    vec4 far = coarse_near(0.5 * (vec2(pixel) + 0.5));
    return known_at(pixel) > 0.5 ? picture_at(pixel) : far;
}

// The mean of the four neighbors in `guess`.
vec4 diffusion_mean() {
    return 0.25 * (guess_at(pixel + ivec2(1, 0)) + guess_at(pixel - ivec2(1, 0)) + guess_at(pixel + ivec2(0, 1))
        + guess_at(pixel - ivec2(0, 1)));
}

// A step from `guess` toward the mean of the neighbors.
vec4 diffusion_step(float weight) {
    vec4 here = guess_at(pixel);
    return known_at(pixel) > 0.5 ? here : here + weight * (diffusion_mean() - here);
}

// What `guess` lacks: how far the mean of the neighbors is from it.
vec4 diffusion_lack() { return known_at(pixel) > 0.5 ? vec4(0.0) : diffusion_mean() - guess_at(pixel); }

// What is lacking at half the size, where pixels are twice as far apart: the sum of `lack`, 0 where a pixel is known.
void diffusion_gather(out vec4 sum, out float sure) {
    sum = vec4(0.0);
    sure = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = 2 * pixel + ivec2(i & 1, i >> 1);
        if (!inside(at, lack_size)) continue;
        sum += lack_at(at);
        sure = max(sure, known_at(at));
    }
    if (sure > 0.5) sum = vec4(0.0);
}

// A step of `guess` toward the change that makes up for `lack`.
vec4 diffusion_correct(float weight) {
    vec4 here = guess_at(pixel);
    return known_at(pixel) > 0.5 ? here : here + weight * (diffusion_mean() + lack_at(pixel) - here);
}

// The guess with the change that makes up for what it lacks.
vec4 diffusion_add() { return guess_at(pixel) + change_at(pixel); }

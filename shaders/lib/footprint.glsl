// Antialiasing of warps: a pixel that covers several pixels of the image averages a grid of samples.

// The most samples along each axis; stronger shrinking may alias. With 16, a hundredth of a percent of the pixels of
// the node polar change by more than 1 / 255; with 4 ten times as many.
const float FOOTPRINT_MOST = 8.0;

// The number of samples along each axis, from the distances between the sides of a pixel in the image.
int footprint_samples(vec2 across, vec2 down) {
    float span = max(length(across), length(down));
    return int(ceil(clamp(span - 0.01, 1.0, FOOTPRINT_MOST)));  // - 0.01: rounding must not make 2 of 1
}

// The offset of sample i of n x n from the center of the pixel.
vec2 footprint_at(int i, int n) { return (vec2(i % max(n, 1), i / max(n, 1)) + 0.5) / float(n) - 0.5; }

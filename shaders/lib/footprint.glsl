// How finely a warp must be sampled: a pixel that spans several pixels of the image averages a grid of them.

const float FOOTPRINT_MOST = 8.0;  // along each axis; where a warp shrinks more, it may alias

// Samples along each axis, from how far apart the sides of a pixel lie in the image, across and down.
int footprint_samples(vec2 across, vec2 down) {
    float span = max(length(across), length(down));
    return int(ceil(clamp(span - 0.01, 1.0, FOOTPRINT_MOST)));  // a span of 1, but for rounding, is one sample
}

// Where sample i of n x n lies, from the middle of its pixel.
vec2 footprint_at(int i, int n) { return (vec2(i % max(n, 1), i / max(n, 1)) + 0.5) / float(n) - 0.5; }

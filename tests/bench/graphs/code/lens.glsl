const vec2 places[47] = vec2[](
    vec2(-0.106430, 0.097499), vec2(0.017846, -0.203343), vec2(0.152110, 0.198400), vec2(-0.284262, -0.050282),
    vec2(0.272321, -0.173229), vec2(-0.091784, 0.341432), vec2(-0.176012, -0.338900), vec2(0.383477, 0.140044),
    vec2(-0.400253, 0.165220), vec2(0.193457, -0.413410), vec2(0.143272, 0.456771), vec2(-0.432606, -0.250703),
    vec2(0.508278, -0.111745), vec2(-0.310604, 0.441805), vec2(-0.071842, -0.554381), vec2(0.441472, 0.372070),
    vec2(-0.594611, 0.024591), vec2(0.434066, -0.431957), vec2(-0.029059, 0.628481), vec2(-0.413578, -0.495600),
    vec2(0.655531, 0.088198), vec2(-0.555722, 0.386661), vec2(0.151926, -0.675341), vec2(0.351563, 0.613517),
    vec2(-0.687548, -0.219342), vec2(0.668114, -0.308691), vec2(-0.289542, 0.691857), vec2(-0.258502, -0.718686),
    vec2(0.688044, 0.361611), vec2(-0.764456, 0.201514), vec2(0.434633, -0.675964), vec2(0.138301, 0.804698),
    vec2(-0.655554, -0.507690), vec2(0.838751, -0.069495), vec2(-0.579869, 0.626832), vec2(0.004218, -0.866015),
    vec2(0.589901, 0.650269), vec2(-0.885960, -0.082103), vec2(0.718004, -0.544950), vec2(-0.163381, 0.898131),
    vec2(-0.492248, -0.782214), vec2(0.902151, 0.247233), vec2(-0.842070, 0.432147), vec2(0.332809, -0.897722),
    vec2(0.365079, 0.896782), vec2(-0.884634, -0.419233), vec2(0.945603, -0.291551)
);

float confusion(float depth, float focus, float aperture, float largest) {
    return min(abs(depth - focus) / depth * aperture, largest);
}

// Depth of field gathered from 47 points of a disc: a point counts if its own circle of confusion reaches the pixel.
vec4 lens(
    vec4 image,      // clamp
    float depth,     // clamp
    float focus,     // = 6, 0..100, scene
    float aperture,  // = 40, 0..100, px
    float largest    // = 16, 0..100, px
) {
    float here = depth_at(pixel), own = confusion(here, focus, aperture, largest), total = 1.0;
    vec4 sum = image_at(pixel);
    for (int i = 0; i < 47; ++i) {
        vec2 away = largest * places[i];
        ivec2 at = clamp(pixel + ivec2(away), ivec2(0), image_size - 1);
        float there = depth_at(at), circle = confusion(there, focus, aperture, largest);
        if (there > here) circle = min(circle, 2.0 * own);
        float weight = clamp(circle - length(away) + 0.5, 0.0, 1.0);
        sum += weight * image_at(at);
        total += weight;
    }
    return sum / total;
}

#include "lib/finite.glsl"

// A correlation: kernel[row][column] weighs the neighbor at that place, without flipping.
vec4 convolve3x3(mat3 kernel, int spacing, float bias, bool filter_alpha) {
    vec4 sum = vec4(0.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            sum += kernel[row][column] * image_at(pixel + spacing * (ivec2(column, row) - 1));
    float alpha = filter_alpha ? sum.a : image_at(pixel).a;
    return finite(vec4(sum.rgb + bias * alpha, alpha));
}

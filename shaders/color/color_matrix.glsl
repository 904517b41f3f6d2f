#include "lib/finite.glsl"

// The nine numbers come row by row and fill columns, so the color stands on the left.
vec4 color_matrix(vec4 image, mat3 matrix, vec3 offset) {
    image = finite(image);
    return finite(vec4(image.rgb * matrix + image.a * offset, image.a));
}

#include "lib/finite.glsl"

// The nine numbers are given by rows and GLSL fills columns with them, so the color stands on the left of the product.
vec4 color_matrix(vec4 image, mat3 matrix, vec3 offset) {
    image = finite(image);
    return finite(vec4(image.rgb * matrix + image.a * offset, image.a));
}

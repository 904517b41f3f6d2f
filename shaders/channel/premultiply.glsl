#include "lib/finite.glsl"

vec4 premultiply(vec4 image) {
    image = finite(image);
    return finite(vec4(image.rgb * image.a, image.a));
}

#include "lib/finite.glsl"

void separate(vec4 image, out float red, out float green, out float blue, out float alpha) {
    image = finite(image);
    red = image.r, green = image.g, blue = image.b, alpha = image.a;
}

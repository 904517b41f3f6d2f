#include "lib/color.glsl"
#include "lib/finite.glsl"

// All four values have the same choices, so this function uses the names of one of them.
float channel_shuffle_pick(int choice, vec4 image, vec4 other) {
    if (choice == RED_RED) return image.r;
    if (choice == RED_GREEN) return image.g;
    if (choice == RED_BLUE) return image.b;
    if (choice == RED_ALPHA) return image.a;
    if (choice == RED_LUMINANCE) return luminance(image.rgb);
    if (choice == RED_ONE) return 1.0;
    if (choice == RED_OTHER_RED) return other.r;
    if (choice == RED_OTHER_GREEN) return other.g;
    if (choice == RED_OTHER_BLUE) return other.b;
    if (choice == RED_OTHER_ALPHA) return other.a;
    if (choice == RED_OTHER_LUMINANCE) return luminance(other.rgb);
    return 0.0;
}

vec4 channel_shuffle(vec4 image, vec4 other, int red, int green, int blue, int alpha) {
    image = finite(image), other = finite(other);
    return finite(vec4(
        channel_shuffle_pick(red, image, other), channel_shuffle_pick(green, image, other),
        channel_shuffle_pick(blue, image, other), channel_shuffle_pick(alpha, image, other)
    ));
}

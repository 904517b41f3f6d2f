#include "lib/alpha.glsl"
#include "lib/finite.glsl"

vec4 color_space_color(vec4 image) { return straight(finite(image)); }

vec4 color_space(vec4 image, vec4 changed) { return finite(premultiplied(vec4(finite(changed.rgb), finite(image.a)))); }

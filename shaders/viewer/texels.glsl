#include "viewer/sample.glsl"
#include "viewer/view.glsl"

// Texels of picture a with the view applied: where the picture is enlarged, these are fewer than pixels of the panel.

uniform sampler2D a;
uniform int a_channels;
uniform ivec4 a_part;
uniform ivec2 viewed_first;

out vec4 result;

void main() {
    vec4 c = sampled(a, a_part, vec2(0.0), vec2(1.0), a_channels, gl_FragCoord.xy + vec2(viewed_first)).value;
    c.rgb *= exposure;
    result = vec4(seen(c), 1.0);
}

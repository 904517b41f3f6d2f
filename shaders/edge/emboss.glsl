#include "lib/display.glsl"

const float emboss_gray = 0.18;  // mid-gray of scene-linear light

float emboss_tone(vec4 image) { return display_tone(image); }

float emboss_height(ivec2 away) { return relief_at(pixel + away); }

vec4 emboss(int kind, float direction, float elevation, float height, int spacing) {
    float falling = emboss_height(spacing * ivec2(1, 1)) - emboss_height(spacing * ivec2(-1, -1)), rising = emboss_height(spacing * ivec2(1, -1)) - emboss_height(spacing * ivec2(-1, 1));
    vec2 slope = vec2(
        2.0 * (emboss_height(spacing * ivec2(1, 0)) - emboss_height(spacing * ivec2(-1, 0))) + falling + rising,
        2.0 * (emboss_height(spacing * ivec2(0, 1)) - emboss_height(spacing * ivec2(0, -1))) + falling - rising
    ) / float(8 * spacing);
    vec3 normal = normalize(vec3(-height * slope, 1.0));
    vec3 light = vec3(cos(elevation) * vec2(cos(direction), -sin(direction)), sin(elevation));
    float shade = finite(max(dot(normal, light), 0.0) / light.z);
    vec4 here = image_at(pixel);
    return finite(vec4(kind == KIND_RELIEF ? vec3(emboss_gray * shade * here.a) : here.rgb * shade, here.a));
}

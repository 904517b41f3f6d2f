#include "lib/finite.glsl"
#include "lib/jump_flood.glsl"

vec4 distance_field_seeds(float mask) { return jump_seeds(finite(mask), vec2(pixel)); }

vec4 distance_field_jump(int reach) {
    vec4 nearest = seeds_at(pixel);
    for (int i = 0; i < 9; ++i)
        if (i != 4) nearest = jump_nearer(nearest, seeds_at(pixel + reach * (ivec2(i % 3, i / 3) - 1)), vec2(pixel));
    return nearest;
}

float distance_field_covered(vec2 at) { return clamp(mask_at(ivec2(at)), 0.0, 1.0); }

float distance_field() {
    vec4 nearest = seeds_at(pixel);
    bool inside_it = nearest.xy == vec2(pixel);
    vec2 seed = inside_it ? nearest.zw : nearest.xy;
    float far = length(vec2(extent));
    if (seed.x >= 0.0) {
        vec4 there = seeds_at(ivec2(seed));
        float inner = distance_field_covered(there.xy), outer = distance_field_covered(there.zw);
        float apart = distance(there.xy, there.zw);
        far = distance(seed, vec2(pixel));
        far -= inside_it ? jump_beyond(1.0 - outer, apart, 1.0 - inner) : jump_beyond(inner, apart, outer);
    }
    return (inside_it ? -far : far) / proxy;
}

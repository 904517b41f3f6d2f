// Jump flooding (Rong and Tan 2006): every pixel learns the nearest pixel of a mask (xy) and the nearest outside of it
// (zw) from others that lie ever closer.

const vec2 JUMP_NOTHING = vec2(-1.0);

vec4 jump_seeds(float mask, vec2 here) { return mask >= 0.5 ? vec4(here, JUMP_NOTHING) : vec4(JUMP_NOTHING, here); }

float jump_distance(vec2 seed, vec2 here) { return seed.x < 0.0 ? 1e9 : distance(seed, here); }

vec4 jump_nearer(vec4 a, vec4 b, vec2 here) {
    return vec4(
        jump_distance(b.xy, here) < jump_distance(a.xy, here) ? b.xy : a.xy,
        jump_distance(b.zw, here) < jump_distance(a.zw, here) ? b.zw : a.zw
    );
}

// How far the edge of the mask lies beyond a seed, toward pixels of the other kind: by its own coverage if that is part,
// else by that of the nearest such pixel. `covered` counts what the seed's kind covers: the mask, or all else.
float jump_beyond(float covered, float apart, float covered_there) {
    return covered < 1.0 ? covered - 0.5 : apart - (0.5 - covered_there);
}

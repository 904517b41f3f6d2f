const vec2 places[16] = vec2[](
    vec2(0.031250, 0.000000), vec2(-0.069128, 0.063327), vec2(0.013660, -0.155652), vec2(0.133096, 0.173600),
    vec2(-0.276951, -0.048988), vec2(0.290041, -0.184501), vec2(-0.105464, 0.392322), vec2(-0.216051, -0.415991),
    vec2(0.499015, 0.182238), vec2(-0.548830, 0.226550), vec2(0.278148, -0.594389), vec2(0.215112, 0.685805),
    vec2(-0.675947, -0.391723), vec2(0.824070, -0.181172), vec2(-0.521209, 0.741371), vec2(-0.124498, -0.960717)
);

// Where a pixel is, seen by a camera of focal length 1.4 that looks along -z.
vec3 place(ivec2 at, float depth) {
    vec2 size = vec2(depth_size), view = vec2(size.x / size.y, 1.0) / 1.4;
    vec2 plane = (vec2(at) + 0.5) / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
    return vec3(plane * view * depth, -depth);
}

// Obscurance from 16 points of a turned spiral around the pixel (after McGuire et al. 2011); 1 is open.
float occlusion(
    float depth,   // clamp
    vec3 normal,   // clamp
    float radius,  // = 24, 0..100, px: of the spiral
    float reach,   // = 0.6, 0..10, scene: what is farther away hides nothing
    float bias     // = 0.02, 0..1, ratio: what rises less hides nothing
) {
    float here = depth_at(pixel), hidden = 0.0;
    vec3 center = place(pixel, here), up = normal_at(pixel);
    float turn = float((pixel.x * 73 ^ pixel.y * 151) & 255) * (6.28318530718 / 256.0);
    vec2 way = vec2(cos(turn), sin(turn));
    for (int i = 0; i < 16; ++i) {
        vec2 spot = places[i];
        vec2 away = radius * vec2(spot.x * way.x - spot.y * way.y, spot.x * way.y + spot.y * way.x);
        ivec2 at = clamp(pixel + ivec2(away), ivec2(0), depth_size - 1);
        vec3 apart = place(at, depth_at(at)) - center;
        float square = dot(apart, apart);
        if (square < reach * reach) hidden += max(0.0, dot(apart, up) - bias * here) / (square + 1e-3);
    }
    return max(0.0, 1.0 - 2.0 * hidden * reach / 16.0);
}

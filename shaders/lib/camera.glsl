// Positions in the world and in the picture. `rows` and `rays` are `rows` and `inverse` of a Camera. u and v are
// fractions of the picture from its top left, depth is planar.

// u, v of the center of a pixel.
vec2 camera_uv(ivec2 at, ivec2 size) { return (vec2(at) + 0.5) / vec2(size); }

// The position of the camera.
vec3 camera_eye(const vec4 rays[3]) { return vec3(rays[0].w, rays[1].w, rays[2].w); }

// The vector from the camera to the point at depth 1. Its length is the ratio of distance to depth.
vec3 camera_ray(const vec4 rays[3], vec2 uv) {
    vec3 seen = vec3(uv, 1.0);
    return vec3(dot(rays[0].xyz, seen), dot(rays[1].xyz, seen), dot(rays[2].xyz, seen));
}

// The position in the world at a depth.
vec3 camera_place(const vec4 rays[3], vec2 uv, float depth) { return camera_eye(rays) + depth * camera_ray(rays, uv); }

// (u d, v d, d) of a position in the world. It is in front of the camera where d is above 0; u, v = xy / d.
vec3 camera_project(const vec4 rows[3], vec3 place) {
    vec4 world = vec4(place, 1.0);
    return vec3(dot(rows[0], world), dot(rows[1], world), dot(rows[2], world));
}

// The normal, toward the camera, of a plane whose nearness (1 / depth) has the relative slope `slope` along u and v. On
// a plane n . place = k, so its nearness is n . ray / k, which is linear in u and v.
vec3 camera_normal(const vec4 rows[3], vec2 uv, vec2 slope) {
    return -normalize(slope.x * rows[0].xyz + slope.y * rows[1].xyz + (1.0 - dot(uv, slope)) * rows[2].xyz);
}

// Projection of meshes. Matrices are given as rows, three each: now, before, after.

// A position in the world as (u d, v d, d): u and v are fractions of the picture from its top left, d is the depth.
vec3 raster_seen(const vec4 cameras[9], int first, vec3 place) {
    vec4 p = vec4(place, 1.0);
    return vec3(dot(cameras[first], p), dot(cameras[first + 1], p), dot(cameras[first + 2], p));
}

// The position in clip space. Row 0 of the picture is row 0 of the texture. There is no far plane: everything beyond
// `near` is kept. `window` says which part is drawn, as fractions of the part: the size of the picture, and the place of
// the part in it.
vec4 raster_clip(vec3 seen, float near, vec4 window) {
    return vec4(2.0 * (seen.xy * window.xy - seen.z * window.zw) - seen.z, seen.z - 2.0 * near, seen.z);
}

vec3 raster_moved(const vec4 motions[9], int first, vec3 place) { return raster_seen(motions, first, place); }

// Rigid motions rotate normals like directions.
vec3 raster_turned(const vec4 motions[9], vec3 normal) {
    return vec3(dot(motions[0].xyz, normal), dot(motions[1].xyz, normal), dot(motions[2].xyz, normal));
}

// The unit normal of the side that faces the camera.
vec3 raster_facing(vec3 normal, vec3 place, vec3 eye) {
    normal = normalize(normal);
    return dot(normal, eye - place) < 0.0 ? -normal : normal;
}

// The motion of a point from the previous frame and to the next one, in pixels of the full size, y down.
vec4 raster_velocity(vec3 now, vec3 before, vec3 after, vec2 size) {
    vec2 at = now.xy / now.z;
    return vec4(at - before.xy / before.z, after.xy / after.z - at) * size.xyxy;
}

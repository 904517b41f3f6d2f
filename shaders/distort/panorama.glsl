#include "lib/environment.glsl"
#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/pi.glsl"

// Directions have x to the front, y to the left and z up. Projections are numbered as the options of `source` and
// `target` are, which are the same.

const vec2 panorama_nowhere = vec2(-1e6);
const int PANORAMA_RIGHT = 0, PANORAMA_LEFT = 1, PANORAMA_UP = 2, PANORAMA_DOWN = 3, PANORAMA_FRONT = 4,
    PANORAMA_BACK = 5;

// The cells of a cube cross, row by row; -1 are empty.
const int panorama_cross[12] = int[](
    -1, PANORAMA_UP, -1, -1, PANORAMA_LEFT, PANORAMA_FRONT, PANORAMA_RIGHT, PANORAMA_BACK, -1, PANORAMA_DOWN, -1, -1
);

// The cell of each face in a cube cross.
const ivec2 panorama_cells[6] = ivec2[](ivec2(2, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 2), ivec2(1, 1), ivec2(3, 1));

// The direction of a place on a face, from -1 to 1, right and down, as seen from inside.
vec3 panorama_of_face(int face, vec2 p) {
    if (face == PANORAMA_RIGHT) return vec3(-p.x, -1.0, -p.y);
    if (face == PANORAMA_LEFT) return vec3(p.x, 1.0, -p.y);
    if (face == PANORAMA_UP) return vec3(p.y, -p.x, 1.0);
    if (face == PANORAMA_DOWN) return vec3(-p.y, -p.x, -1.0);
    return face == PANORAMA_FRONT ? vec3(1.0, -p.x, -p.y) : vec3(-1.0, p.x, -p.y);
}

// The inverse: the face that a direction meets, and where.
int panorama_face(vec3 way, out vec2 p) {
    vec3 size = abs(way);
    float far = max(max(size.x, size.y), size.z);
    vec3 on = way / far;
    if (size.z == far) {
        bool up = way.z > 0.0;
        p = vec2(-on.y, up ? on.x : -on.x);
        return up ? PANORAMA_UP : PANORAMA_DOWN;
    }
    if (size.x == far) {
        bool front = way.x > 0.0;
        p = vec2(front ? -on.y : on.y, -on.z);
        return front ? PANORAMA_FRONT : PANORAMA_BACK;
    }
    bool left = way.y > 0.0;
    p = vec2(left ? on.x : -on.x, -on.z);
    return left ? PANORAMA_LEFT : PANORAMA_RIGHT;
}

bool panorama_is_cube(int projection) {
    return projection == SOURCE_CUBE_STRIP || projection == SOURCE_CUBE_CROSS;
}

// The left top corner of a face.
vec2 panorama_corner(int face, int projection, vec2 side) {
    return side * (projection == SOURCE_CUBE_STRIP ? vec2(face, 0.0) : vec2(panorama_cells[face]));
}

vec2 panorama_side(int projection, vec2 size) {
    return size / (projection == SOURCE_CUBE_STRIP ? vec2(6.0, 1.0) : vec2(4.0, 3.0));
}

// The direction of a place in a picture; 0 where there is none.
vec3 panorama_way(vec2 at, vec2 size, int projection, float angle) {
    if (projection == SOURCE_LAT_LONG) return environment_way(at / size, false, 0.0);
    if (panorama_is_cube(projection)) {
        vec2 side = panorama_side(projection, size);
        ivec2 cell = ivec2(floor(at / side));
        int face = projection == SOURCE_CUBE_STRIP ? clamp(cell.x, 0, 5)
                                                   : panorama_cross[clamp(cell.x, 0, 3) + 4 * clamp(cell.y, 0, 2)];
        if (face < 0) return vec3(0.0);
        return normalize(panorama_of_face(face, 2.0 * (at - panorama_corner(face, projection, side)) / side - 1.0));
    }
    vec2 p = (2.0 * at - size) / size.y;
    float far = length(p);
    if (projection == SOURCE_PERSPECTIVE) return normalize(vec3(1.0, -p * tan(0.5 * angle)));
    if (far > 1.0 && projection != SOURCE_LITTLE_PLANET) return vec3(0.0);
    float away = projection == SOURCE_FISHEYE ? 0.5 * angle * far
        : projection == SOURCE_MIRROR_BALL ? 2.0 * atan(far, sqrt(max(1.0 - far * far, 0.0)))
                                           : 2.0 * atan(far * tan(0.25 * angle));
    vec3 way = vec3(cos(away), far > 0.0 ? -sin(away) * p / far : vec2(0.0));
    return projection == SOURCE_LITTLE_PLANET ? vec3(way.z, way.y, -way.x) : way;  // it looks down, its top is the front
}

// The place of a direction in a picture.
vec2 panorama_place(vec3 way, vec2 size, int projection, float angle) {
    if (projection == SOURCE_LAT_LONG) return environment_uv(way, false, 0.0) * size;
    if (panorama_is_cube(projection)) {
        vec2 p, side = panorama_side(projection, size);
        int face = panorama_face(way, p);
        return panorama_corner(face, projection, side) + side * (0.5 + 0.5 * p);
    }
    if (projection == SOURCE_LITTLE_PLANET) way = vec3(-way.z, way.y, way.x);
    float across = length(way.yz), away = atan(across, way.x);  // drivers approximate acos() to three digits only
    if (projection == SOURCE_PERSPECTIVE && way.x < 1e-4) return panorama_nowhere;
    float far = projection == SOURCE_FISHEYE ? 2.0 * away / angle
        : projection == SOURCE_MIRROR_BALL ? sin(0.5 * away)
        : projection == SOURCE_PERSPECTIVE ? tan(away) / tan(0.5 * angle)
                                           : tan(min(0.5 * away, 1.57)) / tan(0.25 * angle);
    vec2 at = 0.5 * size + 0.5 * size.y * (across > 0.0 ? -way.yz / across : vec2(0.0)) * far;
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, size)) ? at : panorama_nowhere;
}

// Pixels to a radian, around a direction of a picture.
float panorama_density(vec3 way, vec2 size, int projection, float angle) {
    if (projection == SOURCE_LAT_LONG) return size.y / PI;
    vec3 part = abs(way);
    float near = max(max(part.x, part.y), part.z);
    if (panorama_is_cube(projection)) return 0.5 * panorama_side(projection, size).y / (near * near);
    if (projection == SOURCE_FISHEYE) return size.y / angle;
    if (projection == SOURCE_MIRROR_BALL) return 0.25 * size.y;
    if (projection == SOURCE_PERSPECTIVE) return 0.5 * size.y / (tan(0.5 * angle) * max(way.x * way.x, 1e-4));
    return 0.5 * size.y / (tan(0.25 * angle) * max(1.0 - way.z, 1e-4));  // 2 cos^2 of half the angle to the ground
}

// A pixel at or next to a face of a cube: beyond its side lies the face that joins there, not the neighbor in the file.
vec4 panorama_texel(ivec2 p, vec2 corner, int face, int projection, vec2 size) {
    vec2 side = panorama_side(projection, size), on = (vec2(p) + 0.5 - corner) / side;
    if (on == clamp(on, 0.0, 1.0)) return image_at(p);
    int beside = panorama_face(panorama_of_face(face, 2.0 * on - 1.0), on);
    vec2 at = clamp(side * (0.5 + 0.5 * on), vec2(0.5), side - 0.5);  // of a corner, where rounding could leave the face
    return image_at(ivec2(floor(panorama_corner(beside, projection, side) + at)));
}

// The picture in a direction, interpolated.
vec4 panorama_color(vec3 way, int projection, float angle) {
    vec2 size = vec2(image_size), at = panorama_place(way, size, projection, angle);
    if (at == panorama_nowhere) return vec4(0.0);
    if (!panorama_is_cube(projection)) return image_near(at);
    vec2 on;
    int face = panorama_face(way, on);
    vec2 from = panorama_corner(face, projection, panorama_side(projection, size));
    vec2 low = floor(at - 0.5), t = at - 0.5 - low;
    ivec2 p = ivec2(low), x = ivec2(1, 0), y = ivec2(0, 1);
    vec4 above = mix(
        panorama_texel(p, from, face, projection, size), panorama_texel(p + x, from, face, projection, size), t.x
    );
    vec4 below = mix(
        panorama_texel(p + y, from, face, projection, size), panorama_texel(p + x + y, from, face, projection, size), t.x
    );
    return mix(above, below, t.y);
}

vec4 panorama(int source, float source_angle, int target, float angle, mat3 turn) {
    vec2 at = vec2(pixel) + 0.5, size = vec2(extent), x = vec2(0.25, 0.0), y = x.yx;
    vec3 middle = panorama_way(at, size, target, angle);
    // Quarters of a pixel on each side: at half a pixel lies the next face of a cube.
    vec3 across = panorama_way(at + x, size, target, angle) - panorama_way(at - x, size, target, angle);
    vec3 down = panorama_way(at + y, size, target, angle) - panorama_way(at - y, size, target, angle);
    float density = 2.0 * panorama_density(turn * middle, vec2(image_size), source, source_angle);
    int n = footprint_samples(vec2(density * length(across), 0.0), vec2(0.0, density * length(down)));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) {
        vec3 way = panorama_way(at + footprint_at(i, n), size, target, angle);
        if (way != vec3(0.0)) sum += panorama_color(turn * way, source, source_angle);
    }
    return finite(sum / float(n * n));
}

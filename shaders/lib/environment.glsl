// Environment pictures by longitude and latitude, up at the top. With z up, x is in the middle and y a quarter to the
// left, as in Blender; with y up, z is in the middle and x a quarter to the left, as in OpenEXR.
#include "lib/pi.glsl"

// The place of a direction in the picture, as fractions of it. `turn` rotates the surroundings counterclockwise, seen
// from above.
vec2 environment_uv(vec3 way, bool y_up, float turn) {
    if (y_up) way = way.zxy;
    float longitude = way.xy == vec2(0.0) ? 0.0 : atan(way.y, way.x);
    float below = atan(length(way.xy), way.z);  // drivers approximate acos() to three digits only
    return vec2(fract(0.5 - (longitude - turn) / (2.0 * PI)), below / PI);
}

// The direction of a place in the picture.
vec3 environment_way(vec2 uv, bool y_up, float turn) {
    float longitude = (0.5 - uv.x) * 2.0 * PI + turn, below = uv.y * PI;
    vec3 way = vec3(sin(below) * vec2(cos(longitude), sin(longitude)), cos(below));
    return y_up ? way.yzx : way;
}

// The solid angle of a pixel in a row.
float environment_angle(int row, ivec2 size) {
    float height = PI / float(size.y);
    float below = float(row) * height;
    return (cos(below) - cos(below + height)) * 2.0 * PI / float(size.x);
}

// The four pixels around a direction, with their weights.
struct Corners { ivec2 at[4]; vec4 weight; };

// The four pixels around a place of the picture, with the weights of bilinear interpolation.
Corners environment_corners(vec2 uv, ivec2 size) {
    vec2 at = uv * vec2(size) - 0.5, part = at - floor(at), rest = 1.0 - part;
    ivec2 first = ivec2(floor(at));
    return Corners(
        ivec2[4](
            edge_panorama(first, size), edge_panorama(first + ivec2(1, 0), size),
            edge_panorama(first + ivec2(0, 1), size), edge_panorama(first + ivec2(1, 1), size)
        ),
        vec4(rest.x * rest.y, part.x * rest.y, rest.x * part.y, part.x * part.y)
    );
}

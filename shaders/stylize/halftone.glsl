#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/pi.glsl"

// The part of a unit square that a disc around its center covers.
float halftone_disc(float radius) {
    float square = radius * radius, disc = PI * square;
    if (radius <= 0.5) return disc;
    // An arc tangent instead of acos(0.5 / radius), which drivers approximate: off by 4e-4, black had holes.
    float chord = sqrt(square - 0.25);
    return disc - 4.0 * (square * atan(2.0 * chord, 1.0) - 0.5 * chord);
}

// The tone at which ink reaches this place of a cell. All values are equally frequent, so ink where it is below a tone
// covers exactly that part of the cell.
float halftone_threshold(int pattern, vec2 place, float angle) {
    vec2 along = vec2(cos(angle), sin(angle));
    vec2 q = abs(fract(vec2(dot(place, along), dot(place, vec2(-along.y, along.x)))) - 0.5);
    if (pattern == PATTERN_DOT) return halftone_disc(length(q));
    if (pattern == PATTERN_LINE) return 2.0 * q.y;
    float free = 1.0 - 2.0 * min(q.x, q.y);
    return 1.0 - free * free;
}

vec3 halftone_print(vec4 inks, int pattern, vec2 place, float angle) {
    const vec4 angles = vec4(0.26179939, 1.30899694, 0.0, 0.78539816);  // C 15, M 75, Y 0, K 45 degrees, as in print
    vec3 paper = vec3(1.0);
    for (int i = 0; i < 4; ++i)
        if (inks[i] > 0.0 && halftone_threshold(pattern, place, angle + angles[i]) < inks[i])
            paper *= i == 3 ? vec3(0.0) : vec3(i != 0, i != 1, i != 2);
    return paper;
}

vec4 halftone(vec4 image, int inks, int pattern, float size, float angle) {
    vec4 color = straight(finite(image));
    vec3 absorbed = 1.0 - clamp(color.rgb, 0.0, 1.0);
    float black = inks == INKS_CMYK ? smallest(absorbed) : 1.0 - clamp(luminance(color.rgb), 0.0, 1.0);
    vec4 cover = vec4(inks == INKS_CMYK ? (absorbed - black) / max(1.0 - black, 1e-6) : vec3(0.0), black);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        vec2 place = vec2(pixel) + (vec2(i % 3, i / 3) + 0.5) / 3.0;
        sum += halftone_print(cover, pattern, place / max(finite(size), 0.5), finite(angle));
    }
    return vec4(sum / 9.0 * clamp(color.a, 0.0, 1.0), color.a);
}

// Removes the noise of few rays from `light`, without blurring what is sharp: an a-trous filter that is guided by
// variance (Dammertz et al. 2010, Schied et al. 2017). `guide` is the normal and the nearness of every pixel. `spread`
// is the variance of the luminance, how many pixels wide a point of light is blurred by the surface, and the roughness.
// Each pass reads 3 x 3 pixels that lie farther apart than those before: together they cover a wide area. Weights are
// the same from p to q as from q to p, so a bright dot is spread, and its energy is kept.
#include "lib/camera.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/occlusion.glsl"

// Surfaces whose roughness differs by 1 / 8 are different. A choice: with 4 or 16, 5 % of the pixels of the preset
// wet_floor change by more than 1 / 255.
const float DENOISE_ROUGH = 8.0;
// Of the width of the blur: farther pixels count less and less. A choice between noise and sharpness: with half or
// twice the number, a tenth of the pixels of screen_reflections on the sample frame change by more than 1 / 255.
const float DENOISE_REACH = 1.0;
// Of the luminance: less contrast is never noise. With half or twice the number no pixel of wet_floor changes by
// 1 / 255.
const float DENOISE_LEAST = 1e-3;
// The least cosine by which a reflection counts as narrower across: at 87 degrees. With half or twice the number no pixel
// of wet_floor changes by 1 / 255.
const float DENOISE_GRAZING = 0.05;

// What a pixel needs of itself to compare others with it.
struct Denoised { vec4 guide, light; vec3 place, spread; vec2 up; float squeeze, apart; };

// The pixel that is made.
Denoised denoise_here(const vec4 rays[3]) {
    vec4 guide = guide_at(pixel);
    float depth = 1.0 / max(guide.w, 1e-30);
    vec3 place = depth * camera_ray(rays, camera_uv(pixel, extent));
    vec3 right = vec3(rays[0].x, rays[1].x, rays[2].x), down = vec3(rays[0].y, rays[1].y, rays[2].y);
    vec2 up = vec2(dot(guide.xyz, normalize(right)), dot(guide.xyz, normalize(down)));
    float facing = abs(dot(guide.xyz, normalize(place)));
    up = dot(up, up) > 1e-12 ? normalize(up) : vec2(0.0, 1.0);
    float apart = pixel_pitch(rays, depth, vec2(extent));
    return Denoised(guide, light_at(pixel), place, spread_at(pixel), up, 1.0 / max(facing, DENOISE_GRAZING), apart);
}

// How far a pixel is, in pixels of the blur along its longer side: reflections at grazing angles are narrower across.
float denoise_away(Denoised here, ivec2 off) {
    float along = dot(vec2(off), here.up), across = abs(dot(vec2(off), vec2(-here.up.y, here.up.x)));
    // Half a pixel to either side belongs to every pixel. Without it columns of noise stay apart.
    across += (here.squeeze - 1.0) * max(across - 0.5, 0.0);
    return length(vec2(along, across));
}

// The weight of another pixel of the same surface; 0 outside of the picture and on other surfaces.
float denoise_same(const vec4 rays[3], Denoised here, ivec2 at, vec3 spread, float stride) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent))) return 0.0;
    vec4 guide = guide_at(at);
    if (guide.w <= 0.0) return 0.0;
    vec3 way = camera_ray(rays, camera_uv(at, extent)) / guide.w - here.place;
    float same = same_surface(here.guide.xyz, guide.xyz, way, here.apart * stride);
    // On curved surfaces neighbors mirror other directions, and a smooth one shows it.
    same *= clamp(2.0 - distance(here.guide.xyz, guide.xyz) / (0.5 * spread.z * spread.z), 0.0, 1.0);
    return same * clamp(1.0 - DENOISE_ROUGH * abs(spread.z - here.spread.z), 0.0, 1.0);
}

// The first pass: the mean over 4 x 4 pixels, which is one period of the noise; over fewer pixels where the light is
// sharper.
void denoise_period(const vec4 rays[3], int count, out vec4 light, out vec3 spread) {
    Denoised here = denoise_here(rays);
    light = here.light, spread = here.spread;
    if (here.guide.w <= 0.0 || spread.y <= 0.0) return;
    vec4 sum = vec4(0.0);
    float total = 0.0, total_square = 0.0, square = 0.0, reach = 0.0, total_shine = 0.0;
    for (int i = 0; i < 25; ++i) {
        ivec2 off = ivec2(i % 5, i / 5) - 2, at = pixel + off;
        vec3 other = spread_at(at);
        float weight = clamp(0.5 * min(other.y, here.spread.y) + 1.0 - denoise_away(here, off), 0.0, 1.0);
        weight *= (abs(off.x) == 2 ? 0.5 : 1.0) * (abs(off.y) == 2 ? 0.5 : 1.0);
        if (weight > 0.0 && at != pixel) weight *= denoise_same(rays, here, at, other, 1.0);
        if (weight <= 0.0) continue;
        vec4 there = light_at(at);
        sum += weight * there;
        // Bright light shows a wrong blur most.
        float shine = weight * (abs(luminance(there.rgb)) + 1e-6);
        reach += shine * other.y;
        total_shine += shine;
        square += weight * other.x;
        total_square += weight * weight;
        total += weight;
    }
    light = finite(sum / total);
    float mean = luminance(light.rgb), variance = max(square / total - mean * mean, 0.0);
    spread = finite(vec3(variance * total_square / (total * total * float(count)), reach / total_shine, here.spread.z));
}

// A later pass over 3 x 3 pixels that are `stride` apart. Light that differs by more than `contrast` standard
// deviations stays apart.
void denoise_level(const vec4 rays[3], int stride, float contrast, out vec4 light, out vec3 spread) {
    Denoised here = denoise_here(rays);
    light = here.light, spread = here.spread;
    if (here.guide.w <= 0.0 || spread.y <= float(stride)) return;
    // The weights of a binomial filter: 4 in the middle, 2 beside it, 1 at the corners.
    float bright = luminance(here.light.rgb), total = 4.0, variance = 16.0 * here.spread.x;
    vec4 sum = 4.0 * here.light;
    for (int i = 0; i < 9; ++i) {
        if (i == 4) continue;
        ivec2 off = ivec2(i % 3, i / 3) - 1, at = pixel + stride * off;
        vec3 other = spread_at(at);
        float reach = DENOISE_REACH * min(other.y, here.spread.y);
        float weight = clamp(2.0 * reach / denoise_away(here, stride * off) - 1.0, 0.0, 1.0);
        weight *= off.x == 0 || off.y == 0 ? 2.0 : 1.0;
        if (weight > 0.0) weight *= denoise_same(rays, here, at, other, float(stride));
        if (weight <= 0.0) continue;
        vec4 there = light_at(at);
        float shine = luminance(there.rgb), noise = sqrt(here.spread.x + other.x) + DENOISE_LEAST * (bright + shine);
        weight *= exp(-abs(shine - bright) / (contrast * noise + 1e-12));
        sum += weight * there;
        variance += weight * weight * other.x;
        total += weight;
    }
    light = finite(sum / total);
    spread = finite(vec3(variance / (total * total), spread.yz));
}

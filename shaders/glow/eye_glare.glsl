#include "lib/glare.glsl"
#include "lib/noise.glsl"
#include "lib/pi.glsl"
#include "lib/spectrum.glsl"

const float eye_glare_halo_end = 6.0;  // degrees that the table spans: the halo is dark beyond

// The weights of the terms f1, f2 and f3 for photopic, mesopic and scotopic vision (Spencer et al. 1995). The rest is
// f0, light that is not scattered.
const vec3 eye_glare_shares[3] = vec3[](vec3(0.478, 0.138, 0.0), vec3(0.478, 0.138, 0.016), vec3(0.478, 0.207, 0.033));

vec4 eye_glare_light(vec4 image) { return glare_light(image); }

vec4 eye_glare_shrink(int factor) { return glare_shrunk(factor); }

// The lenticular halo f3 of white light by angle, per steradian: each wavelength makes a ring.
vec4 eye_glare_halo() {
    float angle = (float(pixel.x) + 0.5) / float(extent.x) * eye_glare_halo_end;
    vec3 sum = vec3(0.0), white = vec3(0.0);
    // With steps of 2.5 or 10 nm the glare changes by 0.3 % at most.
    for (float nm = 400.0; nm <= 700.0; nm += 5.0) {
        vec3 color = spectrum_color(nm);
        float away = angle - 3.0 * nm / 568.0;
        sum += color * 436.9 * (568.0 / nm) * exp(-19.75 * away * away);
        white += color;
    }
    return vec4(sum / white, 0.0);
}

// The light scattered by an angle in degrees, per steradian.
vec3 eye_glare_scattered(float angle, vec3 shares) {
    float away = angle + 0.02;
    vec3 halo = shares.z > 0.0 && angle < eye_glare_halo_end
        ? halo_near(vec2(angle / eye_glare_halo_end * float(halo_size.x), 0.5)).rgb : vec3(0.0);
    return vec3(shares.x * 20.91 / (away * away * away) + shares.y * 72.37 / (away * away)) + shares.z * halo;
}

// The rays of the ciliary corona, as a factor with mean 1. Rays thinner than pixels fade out. There are three sizes of
// them, 30, 75 and 188 around a light, whose numbers are chosen by eye.
float eye_glare_rays(vec2 way, float pixels, float rays) {
    float sum = 0.0, away = length(way);
    vec2 toward = way / away;
    for (float count = 30.0; count < 200.0; count *= 2.5) {
        float width = 2.0 * PI * away / (pixels * count);
        vec3 place = vec3(toward * count / (2.0 * PI), 0.6 * log(away) + count);
        sum += smoothstep(2.0, 5.0, width) * gradient_noise(place, uvec3(0u)).x;
    }
    return 1.0 + rays * clamp(2.0 * sum, -1.0, 1.0);
}

// The part of a pixel's light that goes to another pixel. A pixel of the kernel covers `cell` pixels of `pitch`
// degrees. Within `fade` the kernel at full size crosses over to the smaller one. Light that stays in its own pixel is
// left out.
vec4 eye_glare_kernel(int vision, float pitch, int cell, vec2 fade, float rays) {
    vec2 way = float(cell) * vec2(pixel - extent / 2);
    float away = length(way);
    if (away == 0.0) return vec4(0.0);
    bool whole = fade.x == fade.y;
    float share = whole ? 1.0 : smoothstep(fade.x, fade.y, away);
    if (cell == 1 && !whole) share = 1.0 - share;
    if (share == 0.0) return vec4(0.0);
    // Near the center the kernel is steep, so a pixel is the mean of many samples.
    int n = cell == 1 ? int(clamp(96.0 / away, 2.0, 64.0)) : 1;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < n * n; ++i) {
        vec2 inside = (vec2(i % n, i / n) + 0.5) / float(n) - 0.5;
        sum += eye_glare_scattered(pitch * length(way + inside), eye_glare_shares[vision]);
    }
    float steradians = radians(pitch) * radians(pitch);
    vec3 kernel = sum / float(n * n) * steradians * share * eye_glare_rays(pitch * way, pitch * float(cell), rays);
    return vec4(kernel, dot(kernel, vec3(1.0 / 3.0)));
}

// Sharpens the kernel by the blur that enlarging with tents adds: a variance of 1/3 square pixel, corrected to second
// order.
vec4 eye_glare_sharpen() {
    vec4 around = kernel_at(pixel + ivec2(1, 0)) + kernel_at(pixel - ivec2(1, 0))
        + kernel_at(pixel + ivec2(0, 1)) + kernel_at(pixel - ivec2(0, 1));
    return kernel_at(pixel) - (around - 4.0 * kernel_at(pixel)) / 6.0;
}

vec4 eye_glare_grow(int factor) { return near_at(pixel) + far_near(glare_grown(factor)); }

vec4 eye_glare_glow(vec4 image, vec4 glare, float strength) { return vec4(strength * glare.rgb, finite(image.a)); }

// Energy is conserved: a pixel loses the light that it scatters within the picture. Light that would leave the picture
// stays.
vec4 eye_glare(vec4 image, vec4 glare, float strength) {
    vec3 scattered = glare.rgb - glare.a * glare_light(image).rgb;
    return vec4(finite(image.rgb) + strength * scattered, finite(image.a));
}

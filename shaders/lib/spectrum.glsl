// Light of many wavelengths as three primaries. Divide sums by the sum of the responses.
#include "lib/working.glsl"

// The response of red, green and blue to a place in the spectrum, from -1 (red) to 1 (blue): overlapping tents. Alpha
// responds equally to all.
vec4 spectrum_response(float place) { return vec4(max(-place, 0.0), 1.0 - abs(place), max(place, 0.0), 1.0); }

// A Gaussian with different widths below and above its middle.
float spectrum_lobe(float nm, float middle, float below, float above) {
    float t = (nm - middle) / (nm < middle ? below : above);
    return exp(-0.5 * t * t);
}

// The color of light of one wavelength for the CIE 1931 observer (fits by Wyman, Sloan and Shirley 2013), clipped to
// Rec.709. For white light, divide by the sum over 400 to 700 nm.
vec3 spectrum_color(float nm) {
    vec3 xyz = vec3(
        1.056 * spectrum_lobe(nm, 599.8, 37.9, 31.0) + 0.362 * spectrum_lobe(nm, 442.0, 16.0, 26.7)
            - 0.065 * spectrum_lobe(nm, 501.1, 20.4, 26.2),
        0.821 * spectrum_lobe(nm, 568.8, 46.9, 40.5) + 0.286 * spectrum_lobe(nm, 530.9, 16.3, 31.1),
        1.217 * spectrum_lobe(nm, 437.0, 11.8, 36.0) + 0.681 * spectrum_lobe(nm, 459.0, 26.0, 13.8)
    );
    const mat3 rec709 = mat3(
        3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252
    );
    return from_rec709(max(rec709 * xyz, 0.0));
}

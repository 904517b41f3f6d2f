// AgX (Troy Sobotka, 2022) as in Blender 4 and 5: Eary Chow's Rec.2020 version, as a formula instead of its 3D table
// (AgX_LUT_Gen, AgXBaseRec2020.py). Matrices are written by rows and multiplied from the left.
#include "lib/color.glsl"

const mat3 REC709_TO_REC2020 = mat3(
    0.627403896, 0.329283038, 0.043313066,
    0.069097289, 0.919540395, 0.011362316,
    0.016391439, 0.088013308, 0.895595253
);
const mat3 REC2020_TO_REC709 = mat3(
    1.660491002, -0.587641139, -0.072849863,
    -0.124550475, 1.132899897, -0.008349423,
    -0.018150763, -0.100578898, 1.118729661
);
const mat3 AGX_INSET = mat3(
    0.856627153, 0.095121241, 0.048251606,
    0.137318973, 0.761241991, 0.101439036,
    0.111898213, 0.076799419, 0.811302368
);
const mat3 AGX_OUTSET = mat3(
    1.127100582, -0.110606643, -0.016493939,
    -0.141329763, 1.157823702, -0.016493939,
    -0.141329763, -0.110606643, 1.251936407
);

// The range is 10 stops below middle gray and 6.5 above. Middle gray keeps its value (power 2.4).
const float AGX_PIVOT = 10.0 / 16.5;
const float AGX_GRAY = 0.489437090;  // 0.18 ^ (1 / 2.4)
const float AGX_SLOPE = 2.4;

// Jed Smith's sigmoid: linear at the pivot, bent with power 1.5 toward both ends. `reach` makes it end at 0 and 1:
// ((slope x)^-1.5 ((slope x / y)^1.5 - 1))^(-1 / 1.5), with x and y the distances from the pivot to that end.
float agx_sigmoid(float x) {
    float reach = x < AGX_PIVOT ? 0.565675607 : 0.715198286;
    float u = AGX_SLOPE * (x - AGX_PIVOT) / reach;
    return AGX_GRAY + reach * u / pow(1.0 + pow(abs(u), 1.5), 1.0 / 1.5);
}

// The tone curve of one channel: scene light to display light.
float agx_curve(float light) {
    float stops = clamp(log2(max(light, 1e-10) / 0.18), -10.0, 6.5);
    return pow(max(agx_sigmoid((stops + 10.0) / 16.5), 0.0), 2.4);
}

// Scene-linear to display-linear light, within 0..1 in Rec.709. The curves shift hues; 60 % of the shift is undone.
vec3 agx(vec3 rgb) {
    vec3 scene = max(to_rec709(rgb) * REC709_TO_REC2020, 0.0) * AGX_INSET;
    vec3 formed = vec3(agx_curve(scene.r), agx_curve(scene.g), agx_curve(scene.b));
    float turn = hue(formed) - hue(scene);
    formed = with_hue(formed, hue(scene) + 0.4 * (turn - round(turn)));
    return from_rec709(clamp(formed * AGX_OUTSET * REC2020_TO_REC709, 0.0, 1.0));
}

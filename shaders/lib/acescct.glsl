// The ACEScct curve (Academy S-2016-001): light from a millionth to 222 as 0..1, even in stops but for a toe. The curve
// only: primaries stay.

float acescct_encode(float light) {
    return light <= 0.0078125 ? 10.5402377416545 * light + 0.0729055341958355 : (log2(light) + 9.72) / 17.52;
}

float acescct_decode(float code) {
    return code <= 0.155251141552511 ? (code - 0.0729055341958355) / 10.5402377416545 : exp2(code * 17.52 - 9.72);
}

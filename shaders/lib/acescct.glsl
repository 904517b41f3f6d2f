// The ACEScct curve (Academy S-2016-001): light from 0.000001 to 222 as codes from 0 to 1, logarithmic except near
// black. It converts no primaries.

// The code of a light value.
float acescct_encode(float light) {
    return light <= 0.0078125 ? 10.5402377416545 * light + 0.0729055341958355 : (log2(light) + 9.72) / 17.52;
}

// The light of a code: the inverse of acescct_encode().
float acescct_decode(float code) {
    return code <= 0.155251141552511 ? (code - 0.0729055341958355) / 10.5402377416545 : exp2(code * 17.52 - 9.72);
}

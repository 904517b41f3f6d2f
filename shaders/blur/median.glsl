// Sorts two pixels, each channel for itself.
#define ORDER(a, b) { vec4 low = min(v[a], v[b]); v[b] = max(v[a], v[b]); v[a] = low; }

// Moves the minimum of the first n pixels to the front and the maximum to the end. While n is more than half of all
// pixels, neither can be the median, and both are dropped (Smith 1996, median by forgetful selection). This is a macro
// so that n is a constant: loops unroll and pixels stay in registers.
#define ENDS(n) for (int i = 1; i < n; ++i) ORDER(0, i) for (int i = 1; i < n - 1; ++i) ORDER(i, n - 1)

#define SIDE3(i) image_at(pixel + ivec2((i) % 3, (i) / 3) - 1)
#define SIDE5(i) image_at(pixel + ivec2((i) % 5, (i) / 5) - 2)

vec4 median_3x3() {
    vec4 v[6];
    for (int i = 0; i < 6; ++i) v[i] = SIDE3(i);
    ENDS(6) v[0] = SIDE3(6);
    ENDS(5) v[0] = SIDE3(7);
    ENDS(4) v[0] = SIDE3(8);
    ENDS(3)
    return v[1];
}

vec4 median_5x5() {
    vec4 v[14];
    for (int i = 0; i < 14; ++i) v[i] = SIDE5(i);
    ENDS(14) v[0] = SIDE5(14);
    ENDS(13) v[0] = SIDE5(15);
    ENDS(12) v[0] = SIDE5(16);
    ENDS(11) v[0] = SIDE5(17);
    ENDS(10) v[0] = SIDE5(18);
    ENDS(9) v[0] = SIDE5(19);
    ENDS(8) v[0] = SIDE5(20);
    ENDS(7) v[0] = SIDE5(21);
    ENDS(6) v[0] = SIDE5(22);
    ENDS(5) v[0] = SIDE5(23);
    ENDS(4) v[0] = SIDE5(24);
    ENDS(3)
    return v[1];
}

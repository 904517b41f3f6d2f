// Only for a number that is measured: one that is set lets the picture through, and nothing is drawn.
vec4 select(vec4 a, vec4 b, vec4 c, vec4 d, vec4 e, vec4 f, vec4 g, vec4 h, int which) {
    vec4 first = which <= 2 ? (which <= 1 ? a : b) : (which == 3 ? c : d);
    vec4 last = which <= 6 ? (which == 5 ? e : f) : (which == 7 ? g : h);
    return which <= 4 ? first : last;
}

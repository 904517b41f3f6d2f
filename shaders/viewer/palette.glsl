// False colors for stops above and below middle gray: gray is 18 %, greens and blues are darker, warm colors brighter.

vec3 false_color(float light) {
    float stops = log2(max(light, 1e-8) / 0.18);
    if (stops < -6.0) return vec3(0.20, 0.05, 0.35);
    if (stops < -4.0) return vec3(0.10, 0.20, 0.65);
    if (stops < -2.0) return vec3(0.10, 0.50, 0.70);
    if (stops < -0.5) return vec3(0.15, 0.55, 0.25);
    if (stops < 0.5) return vec3(0.50, 0.50, 0.50);
    if (stops < 1.5) return vec3(0.85, 0.60, 0.65);
    if (stops < 2.5) return vec3(0.90, 0.85, 0.30);
    if (stops < 4.0) return vec3(0.95, 0.55, 0.15);
    if (stops < 6.0) return vec3(0.90, 0.15, 0.10);
    return vec3(1.0);
}

// Scales a picture to another size around its center; what does not fit is cropped. `scale` is source pixels per pixel.

vec2 fit_center(vec2 scale) {
    return (vec2(pixel) + 0.5 - 0.5 * vec2(extent)) * scale + 0.5 * vec2(image_size);
}

// A triangle filter as wide as the step between samples: shrinking averages, enlarging interpolates.
vec4 fit(vec2 scale) {
    vec2 center = fit_center(scale), reach = max(scale, vec2(1.0));
    ivec2 first = ivec2(floor(center - reach)), last = ivec2(ceil(center + reach));
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec2 away = abs(vec2(x, y) + 0.5 - center) / reach;
            float weight = max(1.0 - away.x, 0.0) * max(1.0 - away.y, 0.0);
            if (weight > 0.0) {
                sum += weight * image_at(ivec2(x, y));
                total += weight;
            }
        }
    return sum / total;
}

// The nearest pixel, for data, which must not be mixed.
vec4 fit_nearest(vec2 scale) {
    return image_raw(ivec2(floor(fit_center(scale))));
}

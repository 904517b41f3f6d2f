// The color difference of film and video keyers (Vlahos 1964): how far the channel of a screen exceeds the others.

// The channel of a screen of this color: the largest one, green before blue before red.
int keying_channel(vec3 screen) {
    return screen.g >= screen.r && screen.g >= screen.b ? 1 : screen.b >= screen.r ? 2 : 0;
}

// How far a channel exceeds a mix of the other two: balance 0 is the smaller one, 1 the larger.
float keying_excess(vec3 rgb, int channel, float balance) {
    float first = rgb[(channel + 1) % 3], second = rgb[(channel + 2) % 3];
    return rgb[channel] - mix(min(first, second), max(first, second), balance);
}

// How light fades out toward a distance: (1 - (d / reach)^4)^2, for the square of d; 1 everywhere where `reach` is 0. It
// is given as the root of that, which is 0 where no light arrives.
float light_window(float square, float reach) {
    float part = reach > 0.0 ? square / (reach * reach) : 0.0;
    return max(1.0 - part * part, 0.0);
}

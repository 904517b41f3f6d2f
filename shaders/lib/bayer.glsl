// Ordered dithering.

// The threshold of a cell in the Bayer matrix (1973) with 2^bits cells on a side, computed from bits: x ^ y and y
// alternate, and the lowest bits of the place count most.
float bayer(ivec2 cell, int bits) {
    int rank = 0;
    for (int bit = 0; bit < bits; ++bit) {
        int x = (cell.x >> bit) & 1, y = (cell.y >> bit) & 1;
        rank = 4 * rank + 2 * (x ^ y) + y;
    }
    return (float(rank) + 0.5) / float(1 << (2 * bits));
}

// The structure tensor (Förstner and Gülch 1987): products of a picture's derivatives across and down, averaged over a
// neighborhood. Its eigenvectors are the directions of most and least change.

const float STRUCTURE_NONE = 1e-12;  // below this difference of eigenvalues there is no main direction

// The tensor of one pixel, from the change across and down: xx, xy, yy.
vec3 structure_tensor(vec2 change) { return vec3(change.x * change.x, change.x * change.y, change.y * change.y); }

// The difference of the two eigenvalues.
float structure_apart(vec3 tensor) { return length(vec2(tensor.x - tensor.z, 2.0 * tensor.y)); }

// Anisotropy: 0 where all directions are alike, 1 where there is only one.
float structure_anisotropy(vec3 tensor) {
    float apart = structure_apart(tensor);
    return apart > STRUCTURE_NONE ? apart / (tensor.x + tensor.z) : 0.0;
}

// The direction of most change; 0 where all directions are alike.
vec2 structure_across(vec3 tensor) {
    if (structure_apart(tensor) <= STRUCTURE_NONE) return vec2(0.0);
    float turn = 0.5 * atan(2.0 * tensor.y, tensor.x - tensor.z);
    return vec2(cos(turn), sin(turn));
}

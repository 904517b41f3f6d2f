#include "lib/finite.glsl"

void separate_vector(vec3 vector, out float x, out float y, out float z) {
    vector = finite(vector);
    x = vector.x, y = vector.y, z = vector.z;
}

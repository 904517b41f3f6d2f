#include "lib/morphology.glsl"

#include "lib/facing.glsl"

float facing(vec4 rays[3]) { return unit_normal(normal_at(pixel)) != vec3(0.0) ? facing_found(rays) : 0.0; }

const float SCENE_NOTHING = 1e10;  // depth of the background, as Blender writes it

vec3 scene_position(vec4 place) { return place.xyz; }
float scene_depth(vec4 place) { return place.w > 0.0 ? place.w : SCENE_NOTHING; }
vec2 scene_uv(vec4 surface) { return surface.xy; }
float scene_object(vec4 surface) { return surface.z; }
float scene_material(vec4 surface) { return surface.w; }

// A preview light: a lamp from the upper left of the camera, sky light from above, and a little ambient light. Together
// they light a white surface by 1.2 at most; chosen by eye.
vec4 scene_color(vec4 albedo, vec3 normal, vec4 emission, vec3 eye) {
    vec3 left = normalize(cross(vec3(0.0, 0.0, 1.0), eye) + vec3(0.0, 1e-6, 0.0));
    vec3 lamp = normalize(0.7 * left - 0.6 * eye + vec3(0.0, 0.0, 0.9));
    float lit = 0.85 * max(dot(normal, lamp), 0.0) + 0.2 + 0.15 * normal.z;
    return vec4(albedo.rgb * lit + emission.rgb, albedo.a);
}

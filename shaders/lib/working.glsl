// The working space: scene-linear with Rec.709 primaries. For a graph in another one the compiler puts a file of its own
// in the place of this one, with the same names.

const vec3 LUMINANCE_WEIGHTS = vec3(0.2126, 0.7152, 0.0722);  // ITU-R BT.709-6

// Between the working space and linear Rec.709, for what is known of its primaries only.
vec3 to_rec709(vec3 rgb) { return rgb; }
vec3 from_rec709(vec3 rgb) { return rgb; }

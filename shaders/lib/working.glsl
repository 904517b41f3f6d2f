// The working space: scene-linear with Rec.709 primaries. For a graph with another working space the compiler replaces
// this file by one with the same names.

const vec3 LUMINANCE_WEIGHTS = vec3(0.2126, 0.7152, 0.0722);  // ITU-R BT.709-6

// A color of the working space in linear Rec.709, for formulas that are defined for Rec.709 only.
vec3 to_rec709(vec3 rgb) { return rgb; }
// The inverse of to_rec709().
vec3 from_rec709(vec3 rgb) { return rgb; }

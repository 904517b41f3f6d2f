// Light of many wavelengths for three primaries: tents that overlap. Divide sums by the sum of the responses.

// What red, green and blue see at a place in the spectrum from -1, red light, to 1, blue light; alpha sees all alike.
vec4 spectrum_response(float place) { return vec4(max(-place, 0.0), 1.0 - abs(place), max(place, 0.0), 1.0); }

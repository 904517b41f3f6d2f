// The picture with more pixels on the left and above, as many as the margin says, or fewer if it is negative.
vec4 pad(vec2 margin) { return image_at(pixel - ivec2(margin)); }

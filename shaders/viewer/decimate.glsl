// Reads every n-th pixel from `first` on, unchanged.

uniform sampler2D picture;
uniform vec2 first;
uniform vec2 texels;  // texels of the picture per pixel of the result

out vec4 result;

void main() { result = texelFetch(picture, ivec2(first + gl_FragCoord.xy * texels), 0); }

// /*MADE_BY*/ wrote this effect for ReShade (https://reshade.me). It also runs in vkBasalt, on Linux.
// Put it into the folder of shaders, and these files into the folder of textures: /*FILES*/
// It works at /*SIZE*/ pixels; pictures of another size are scaled. Export it at the size of the game.
// The picture of the game is read and shown as sRGB.

#ifndef HALATION_HALF
#define HALATION_HALF 0 // 1 takes half the memory, and rounds light to 11 bits
#endif
#if HALATION_HALF
#define HALATION_COLORS RGBA16F
#else
#define HALATION_COLORS RGBA32F
#endif
#ifdef BUFFER_COLOR_SPACE
#define FETCH(s, x, y) tex2Dfetch(s, int2(x, y))
#else
#define FETCH(s, x, y) tex2Dfetch(s, int4(x, y, 0, 0)) // before ReShade 5, and in vkBasalt
#endif


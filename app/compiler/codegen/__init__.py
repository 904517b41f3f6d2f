"""Third stage: a pass becomes a GLSL program.

The text of a program depends on what is computed, never on values: numbers are uniforms. So dragging a slider compiles
nothing. Names are counted from zero in every pass, so that equal passes, of whatever graphs, share one program.

`emit` writes a whole program. Its parts come from `pass_parts`, which has one writer for each kind of operation that a
pass can end in: a `Call` (and all pointwise operations before it), a `Gather`, a `Convolve`, a `Reduce`. Programs from
outside (`external`) and drawn meshes (`rasterize`) are written as a whole. `bodies` holds the text of accessors,
convolutions and reductions, and `includes` the shader files that a pass needs, cut to the functions that it calls.

Shaders of nodes never sample textures themselves. They read through generated accessors such as `image_at(p)`, and the
accessor decides the rest: the edge mode, the conversion between channels, a sampler or an image load, the offset of a
tile, a constant in place of a picture. So one text of an effect serves all of these.

A program has one of two forms, which make the same bits (a property test compares them). A fragment program makes one
pixel per invocation and needs no more than OpenGL 4.1. A compute program makes several (`forms`), which share what they
read; that is up to four times as fast for blurs on a software rasterizer. `devices` chooses the form.

`#line` directives number the lines of file n from n * LINES_PER_FILE, because not all drivers report file numbers. So
an error in a shader names the file and the line that its author wrote.
"""

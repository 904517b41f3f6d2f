"""First stage: nodes become operations (see `ir`).

A graph says what a user wants; a program of operations says what to compute. Lowering goes from the one to the other in
these steps:

1. Groups are expanded into one flat graph (`expand`), in which a node has a path such as `glow/bloom`. Animated values
   are evaluated at the frame (`graph_at_frames`). A node may read other frames, so the same node can be lowered several
   times, at different frames.
2. The nodes that the requested outputs need are put in an order in which each comes after those that feed it. The order
   is found without recursion, because chains of nodes may be long. A loop is an error here.
3. Each node is lowered in turn (`node_lowering`). A muted or neutral node adds nothing: its outputs stand for what
   feeds it. A pointwise node becomes one `Call`. A filter records its draws in a `Recorder` (`draws`), which turns each
   one into operations; blurs, transforms and Fourier convolutions have modules of their own.
4. The outputs are converted to the types that they declare.

Sizes are known here, before any pixel is: a picture says its size in its header, and a node how its size follows from
those of its inputs. So pictures of another size get a fit, and lengths in pixels shrink with a proxy. All later stages
work with sizes in pixels and never ask again.

Colors need no conversion here: files are brought to the working space where they are decoded.

Why operations and not nodes: passes should be found for what is computed, not for how it is grouped. Two nodes that
compute the same share an operation, a node of ten draws can share its first pass with the node before, and no later
stage knows any node.

`incremental` lowers again only the nodes that changed.
"""

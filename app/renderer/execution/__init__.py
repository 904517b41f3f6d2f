"""Runs plans: decodes pictures, executes passes, and downloads results.

**One pass per step.** A `Run` is an iterator. Each `next` uploads what the next pass reads and executes the pass. So
the editor can run as many passes as fit into the time of one of its frames, drop a run when the graph changes, and have
several runs at a time. `WholeRun` executes a plan that fits on the device; `TiledRun` executes one that does not, as
many small plans in a row. A `Runner` starts runs and keeps what they share.

**Results by key.** Every texture belongs to a key, which is a hash of all that decides its pixels. A run takes what is
there under its key and computes the rest. So nothing is ever marked as outdated: changed values give other keys. A
`TextureLease` protects the textures that a run, a panel or a history still needs. All others are idle. The
`TexturePool` keeps idle textures within a budget of bytes and evicts first what is cheap to compute again; `costs`
estimates the seconds.

**Textures are freed early.** Before a run begins, the readers of each surface are counted. After its last reader a
surface loses its lease, and its texture can be used for the next surface of the same size and format.

**Decoding overlaps.** Files are decoded on two threads, in the order in which passes read them, a few ahead of the run
(`decoding`). Pictures that a dropped run has begun are kept for the next one, because the editor drops a run at each
movement of a slider and the next run needs the same files.

**Errors end a run.** Unfinished textures are discarded, all leases are closed, and the error names the node.
"""

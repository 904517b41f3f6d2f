"""Renders frames on other machines: what `halation render --cluster` does, on top of Dask.

Dask connects the machines, decides which worker renders what, and runs tasks again whose worker has gone. This room
adds what Dask cannot know: what a frame is, and whom to blame.

- `chunk` is what is sent: a `FrameChunk`, a render job as JSON for a few frames. The graph travels whole; pictures go
  by path with their size and hash. Dask gets one fixed function (`worker_task.render_chunk`) and this text, no objects.
- `worker_task` runs on a worker. It hands the text to a warm process beside the worker (`render_process`), because a
  driver may crash, hang, or take all memory: then the worker lives on and says which frames were lost, and a task that
  is cancelled ends at once. The process is `halation worker --chunks`, and keeps its device for the next chunk.
- `file_marks`, `path_map` and `versions` tell whether a worker would render the same pixels.
- `assignments` cuts frames into chunks: as many as take some seconds by the measured cost, fewer towards the end.
- `staged_assignments` cuts jobs whose nodes remember earlier frames into stages that share their results.
- `campaign` sends the chunks and hears what comes of them. A frame that ends its process is tried alone on two other
  workers, then named; all others are finished. A worker that cannot render (another version, no OpenGL) gets no more.
- `workers` lists who may render; `connection` reaches a scheduler, or starts one with workers inside of this process.

Frames appear under their names only when they are complete (`resources.atomic_write`). So a frame that two workers
render, because one was believed to be lost, is harmless: both write the same bytes.
"""

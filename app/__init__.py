"""The machine: graph, compiler, renderer, files, commands."""

"""The inputs of a graph: files and arrays, probed while compiling and read while rendering."""

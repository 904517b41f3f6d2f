"""Edits of graphs as pure functions: a graph in, a graph out. No window, no history, no files."""

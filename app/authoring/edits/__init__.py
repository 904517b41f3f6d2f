"""What a person can do to a graph, as pure functions: a graph in, a graph out. No window, no history, no files."""

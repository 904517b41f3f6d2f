"""Ready graphs, in the same JSON as user files."""

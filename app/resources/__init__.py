"""What rendering asks of the world beyond a graph, and how files are reached: in the sandbox, whole or not at all."""

"""What rendering asks of the world beyond a graph, and how files are reached: within the sandbox, whole or not at all."""

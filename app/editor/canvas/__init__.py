"""The canvas: where nodes are placed and linked."""

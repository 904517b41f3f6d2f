"""Graphs as tests: cases in files beside them, and the pictures that they must give. Light; what renders is inside."""

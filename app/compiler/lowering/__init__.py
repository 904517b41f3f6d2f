"""A graph becomes operations."""

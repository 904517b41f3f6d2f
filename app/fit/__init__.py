"""Finds values of a graph that make its picture like a reference.

`search_space` says which numbers may change and within which ranges, `likeness` how far a picture is from the
reference, `search` counts renders and keeps the best, `least_squares` and `evolution` are the two ways to look for
better values, and `fitting` puts them together: a small proxy first, then the full size. `report` writes what came out.
"""

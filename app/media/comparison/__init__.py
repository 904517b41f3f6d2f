"""Compares pictures: measures of their difference, and sheets that show many side by side."""

"""Parts of pictures: which are needed for which, and tiles."""

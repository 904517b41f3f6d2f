"""Files that change: noticed, read again, rendered again."""

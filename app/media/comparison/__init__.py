"""Pictures beside pictures: how far two are apart, in numbers, and sheets that show many."""

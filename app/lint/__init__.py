"""What is wrong with graph files and how they could be better: everything that `halation check` says."""

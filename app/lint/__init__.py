"""Everything that `halation check` reports: faults of graph files, and warnings about quality."""

"""From graphs to files: frames, where they go, and what files say of themselves."""

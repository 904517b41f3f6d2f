"""What panels share without knowing each other: actions, open dialogs, search, facts of documents. Draws nothing."""

"""Small dialogs: About, questions, the sheet of shortcuts."""

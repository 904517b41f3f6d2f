"""The Preferences dialog, with the editor of shortcuts."""

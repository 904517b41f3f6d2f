"""The dialog that saves a preset."""

"""What can be done from menus: the tables of actions are in the rooms that they work on, those of the window here."""

MENUS = ("File", "Edit", "Graph", "Viewer", "Time", "View", "Help")

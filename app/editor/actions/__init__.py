"""Actions of the Edit, View and Help menus. Actions of a panel are in the folder of that panel."""

MENUS = ("File", "Edit", "Graph", "Viewer", "Time", "View", "Help")

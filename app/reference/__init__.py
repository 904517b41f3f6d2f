"""What pages say about types of nodes, on the site, in the editor and on the command line."""

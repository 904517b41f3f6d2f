// How many rounds the loops of a user's code have made for this pixel: those that might not end are left at some point.

int halation_rounds = 0;

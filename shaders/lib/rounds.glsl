// Counts the rounds of loops in a user's code for this pixel: a loop that may not end stops at a limit.

int halation_rounds = 0;

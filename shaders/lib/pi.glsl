// The ratio of a circle's circumference to its diameter: half a turn in radians.

const float PI = 3.14159265;

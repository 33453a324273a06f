"""fegear as Python users reach it: a case run in a script, gears and pairs, and the everyday questions about them."""

"""Two runs compared: what went in, the single values, and the tables row by row."""

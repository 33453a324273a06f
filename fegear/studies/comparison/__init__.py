"""Two runs held against each other: what went in, the single values, and the tables row by row."""

"""Profile relief that removes the transmission error: loading families, design equations, charts, optimisation."""

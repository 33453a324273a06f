"""What a result shows, as data: its tables, values, figures and notes, filled from what the mechanics declares."""

"""What a result shows, as data: its tables, values, figures and remarks, filled from what the mechanics declares."""

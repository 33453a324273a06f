"""Results of profile relief: designs, charts, sensitivity, flanks."""

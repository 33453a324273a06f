"""What everything stands on: errors, units, frozen arrays, streams, the store of solved teeth."""

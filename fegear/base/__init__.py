"""What everything uses: errors, units, frozen arrays, streams, the store of solved teeth."""

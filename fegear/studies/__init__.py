"""Many runs of one case: sweeps, effects switched one at a time, what accuracy costs."""

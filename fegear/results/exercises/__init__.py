"""Questions of a first course on gears, with their answers by formulas."""

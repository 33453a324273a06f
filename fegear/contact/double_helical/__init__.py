"""Double helical pairs: two halves of opposite hand on common shafts, one member floating along its axis or located."""

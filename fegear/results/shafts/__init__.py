"""Results of shafts and bearings: deflection, bearing forces and lives, tilt of the meshes."""

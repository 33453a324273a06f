"""Shafts on their bearings: Timoshenko beams, nonlinear rolling bearings, deflection, lives, tilt of meshes."""

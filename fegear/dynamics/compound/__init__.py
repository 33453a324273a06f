"""Planetary gear sets described as data: any shafts, planets and meshes on one axis; ratios, torques, phases, modes."""

"""Results of rack and pinion: geometry in mesh, stiffness of the teeth of the rack, loads over the stroke."""

"""Results of one gear: drawing, stiffness, root stress, formulas compared with finite elements."""

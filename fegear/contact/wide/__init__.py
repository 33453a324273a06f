"""Loaded flanks of 3D gears: contact lines, compliance of both solid gears, contact solved over the face.

    from fegear.contact.wide import FlankGaps, FlankPair

    flanks = FlankPair(pair, {"driver": first.fine, "driven": second.fine}, panel=0.5, positions=16)
    known = flanks.compliance(load)                     # the dear part, the same for all gaps and loads about this one
    found = flanks.solve([load], FlankGaps(line_gap=..., face_position=...), known)
    found.transmission_error, found.share, found.line_load, found.pressure, found.face_load_factor

Loads are transverse forces along the transverse line of action; heights z count from the middle of the common face
along the driver's axis, in whose drawing the driver turns clockwise, its loaded flank at x > 0. A ring that drives
turns counter-clockwise there: the ends of the face are those of the same flanks when its planet drives.
"""

"""Motion of a train in time: loss of contact, backlash, friction, and steady motions over speed."""

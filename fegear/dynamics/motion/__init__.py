"""Motion of a train in time: contact loss, backlash, friction, and steady motions over speed."""

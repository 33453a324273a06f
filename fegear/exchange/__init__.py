"""Models of other programs: a gearbox made a commented case."""

"""REXS, the open exchange format of drives: gearboxes read."""

"""Teeth in contact: unloaded flanks, loaded plane and wide pairs, losses and the state of the surfaces."""

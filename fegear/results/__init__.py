"""What a case can ask for: one file per result, in the room of its subject; the catalogue names all of them."""

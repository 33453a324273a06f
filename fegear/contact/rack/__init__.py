"""A pinion on a rack: contacts, compliance by numbered teeth, loads and errors over the stroke."""

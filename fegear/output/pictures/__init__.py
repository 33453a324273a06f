"""Pictures of results: colour-blind safe, labelled with units, one module per topic."""

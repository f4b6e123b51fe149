"""Modal analysis of the linearised rope."""

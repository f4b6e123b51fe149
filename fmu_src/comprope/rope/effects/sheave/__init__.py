"""Effects of the sheave: its guides, bearing, seal, shape and mass, stops and tie-down; one file for each."""

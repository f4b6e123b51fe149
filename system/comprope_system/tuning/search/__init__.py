"""Search for trip profiles and servo gains on the reduced model."""

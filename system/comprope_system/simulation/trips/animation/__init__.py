"""Animation of a trip: compactly encoded shapes of the rope over time for an HTML page."""

"""Design of a compensation rope: the least sheave for all trips and for the building's sway, and where to measure the rope."""

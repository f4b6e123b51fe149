"""Design of a compensation rope: smallest sheave mass for all trips and building sway, sensor heights."""

"""Controllers chosen against the rope: trips and shapers that leave it swinging least, found on a small linear rope."""

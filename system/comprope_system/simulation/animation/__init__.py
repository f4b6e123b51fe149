"""A trip to be watched: the rope's shape in time, packed small, for a page that plays it."""

"""Motion of the building: records as they are replayed, and synthetic ones of earthquake and wind."""

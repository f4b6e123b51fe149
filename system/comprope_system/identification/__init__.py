"""From measurements to a better model: campaigns, comparison, diagnosis, and effects added with fitted parameters."""

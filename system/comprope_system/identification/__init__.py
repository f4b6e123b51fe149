"""From measurements to a better model: comparison, diagnosis of the missing effect, and effects added with fitted parameters."""

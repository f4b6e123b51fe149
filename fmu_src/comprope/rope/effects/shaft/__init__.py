"""Effects of what is in the shaft beside the rope: air, brushes, guides and walls; one file for each."""

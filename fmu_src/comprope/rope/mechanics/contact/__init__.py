"""Contact and friction between rope and groove, and the law of contacts that push only."""

"""Effects added to and removed from a model: one, stepwise selection, backward elimination."""

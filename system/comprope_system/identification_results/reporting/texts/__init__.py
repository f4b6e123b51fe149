"""Results of the identification in words: numbers with units, names and drawings of effects, sentences."""

"""A mass on a spring: the smallest model with hidden state, to test FMUs with."""

"""Generation, compilation and caching of the functions that Python and C call."""

"""A helper with a name that another model may have too."""

WORD = "spring"

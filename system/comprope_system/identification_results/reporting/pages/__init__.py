"""HTML pages of the results of the identification, and the parts that they share."""

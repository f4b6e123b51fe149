"""Self-contained HTML pages of results in a uniform style."""

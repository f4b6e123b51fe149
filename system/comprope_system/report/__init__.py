"""Pages of results: self-contained HTML of one plain look."""

"""CSV and other text files in any encoding."""

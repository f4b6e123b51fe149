"""Commands that dimension an elevator."""

"""Results of the public functions compare, diagnose, add and improve."""

"""Commands that check the program."""

"""One measured run: its files on one clock, its channels, and the motion of car and counterweight."""

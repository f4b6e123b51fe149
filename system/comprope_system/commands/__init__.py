"""One module for each subcommand, found by its name; heavy imports wait until the command runs."""

"""One module for each subcommand, found by its name; modules that begin with an underscore are what commands share.

A command is a thin user of the public interface: it calls the function of `comprope_system` with a progress display, prints
the result's summary, and writes the files asked for. Slow imports are deferred until the command runs.
"""

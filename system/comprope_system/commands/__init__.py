"""Subcommands, in packages by subject: each is a module that is found by its name. Modules with an underscore are shared.

A command is a thin user of the public interface: it calls the function of `comprope_system` with a progress display, prints
the result's summary, and writes the files asked for. Slow imports are deferred until the command runs.
"""

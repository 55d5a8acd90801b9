"""The command line: a thin layer over the pipeline, with one module per group of commands."""

from drivelint.cli.app import app, main

__all__ = ["app", "main"]

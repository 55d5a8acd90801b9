"""The command line: a thin shell over the pipeline, one module per group of commands."""

from drivelint.cli.app import app, main

__all__ = ["app", "main"]

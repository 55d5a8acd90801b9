"""Defines the output of a map reader, and contains the code that all map formats use."""

"""Defines the output of a trace reader, and makes the tables of `schemas/model.sql` from it."""

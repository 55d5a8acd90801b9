"""Defines the output of a trace reader, checks it, and makes the tables of `schemas/model.sql` from it."""

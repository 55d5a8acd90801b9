"""Defines what a trace reader returns, and makes the tables of `schemas/model.sql` of it."""

"""The model of a drive: what a trace reader returns, and how it becomes the tables of `schemas/model.sql`."""

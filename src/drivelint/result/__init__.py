"""A result: the tables that a run writes, and reading them again."""

"""The DuckDB database, its tables, and the syntax trees of statements."""

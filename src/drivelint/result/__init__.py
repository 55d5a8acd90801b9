"""The result of a run: its tables, and the modules that write and read them."""

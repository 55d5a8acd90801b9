"""ASAM OSI: ground truth in MCAP and in `.osi` files, read and written; the lanes that it carries."""

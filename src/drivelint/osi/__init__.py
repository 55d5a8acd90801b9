"""ASAM OSI ground truth in MCAP, written: the schema as far as we use it, frames from whole columns, and the log around them."""

"""Reads ASAM OSI ground truth in MCAP and `.osi` files, with its lanes, and writes it as MCAP."""

"""Reads MCAP files record by record, copies them byte by byte, and writes them."""

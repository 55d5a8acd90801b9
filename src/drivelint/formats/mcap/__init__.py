"""MCAP files: read record by record, copied byte by byte, written."""

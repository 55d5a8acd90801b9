"""Reads CSV and Parquet tables through a mapping, and drivelint's canonical Parquet tables."""

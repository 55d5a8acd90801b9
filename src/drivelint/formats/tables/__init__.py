"""CSV and Parquet tables, through a mapping; the canonical Parquet tables."""

"""Outputs: tables, summaries and reports made of one `Result`; one module per target."""

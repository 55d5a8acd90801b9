"""Comparisons with tools that judge the same rules, outside of CI: `python -m tests.peers stvo`. Each has its own environment."""

"""Logs and maps of 123D: many data sets in one form of Arrow files (py123d, Apache-2.0), read without that package."""

"""Protobuf: schemas cut down to the fields that are read, and messages written by column."""

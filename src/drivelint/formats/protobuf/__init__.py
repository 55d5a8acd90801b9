"""Decodes protobuf messages by schemas that are cut down to the fields that are read, and encodes messages by column."""

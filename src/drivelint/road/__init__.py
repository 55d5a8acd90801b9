"""The model of a road map: the output of a map reader, and code that all map formats share."""

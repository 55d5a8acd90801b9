"""The model of a road map: what a map reader returns, and what all map formats share."""

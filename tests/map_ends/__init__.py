"""Traffic on a road, and the same traffic on a part of it: a log and a map that end say nothing else, or that it is not known."""

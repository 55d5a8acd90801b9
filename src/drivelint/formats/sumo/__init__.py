"""SUMO: floating car data, traffic light states, networks."""

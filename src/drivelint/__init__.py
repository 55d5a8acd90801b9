"""drivelint checks recorded drives against the rules of the road."""

__version__ = "0.1.0"

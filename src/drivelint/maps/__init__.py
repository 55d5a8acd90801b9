"""Maps: any road format to the tables of schemas/map.sql."""

from drivelint.maps.contract import Environment, MapReader, MapSource, Request
from drivelint.maps.registry import load_map, read_source

__all__ = ["Environment", "MapReader", "MapSource", "Request", "load_map", "read_source"]

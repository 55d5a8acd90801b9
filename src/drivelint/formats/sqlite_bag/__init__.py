"""Reads the SQLite files (`.db3`) that `ros2 bag record` writes by default before Iron."""

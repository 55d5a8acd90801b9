"""Bags of ROS 2 in SQLite."""

"""CommonRoad scenarios: obstacles, lights and lanelets."""

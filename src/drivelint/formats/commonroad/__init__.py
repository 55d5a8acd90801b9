"""CommonRoad scenarios: obstacles, lights, and the lanelets under them."""

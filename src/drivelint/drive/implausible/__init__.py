"""Reports doubts about motion that is impossible for a road user, and about tracks that are not separate bodies."""

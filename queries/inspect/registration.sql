SELECT ego_id, ok, reason, n_steps AS steps, n_on_lane AS on_lane, n_moving AS moving, n_with_direction AS with_direction,
    lateral_median_m, is_aside AS aside
FROM registration

-- The ego's own motion, filtered before it is differentiated: an acceleration is the least-squares slope of v_long over the samples within
-- 0.25 s on either side (2.2 periods where that is more: always two samples), jerk the same over the accelerations, and the yaw rate the
-- same over the heading. At 20 Hz that is a mean over half a second: a spike of one sample is seen at a third of its height, not hidden.
-- NULL where the velocity itself comes from a filter (quality velocity_filtered), where a sample within is not known, where the samples do not reach 0.7 of that to both sides (the log's ends, a hole), and in logs
-- with less than 5 samples a second, where it would be a mean over so long a time that a harsh braking vanishes in it.
-- A mean over half a second flattens a peak: *_peak is by how much at most the true peak may be higher, where the value stands out over
-- both of its neighbours half a window away (see peak_rise).
-- The sums are those of whole numbers (nm/s, nrad, ns), hence exact: the same in every order, alone and in a crowd.
WITH sample AS (
    SELECT
        st.drive_id, st.ego_id, st.seg, st.t_ns,
        s.vx_mps * cos(s.yaw_rad) + s.vy_mps * sin(s.yaw_rad) AS v_long_mps,
        round(1e9 * (s.vx_mps * cos(s.yaw_rad) + s.vy_mps * sin(s.yaw_rad)))::HUGEINT AS v,
        round(1e9 * s.yaw_rad)::BIGINT AS yaw,
        round(1e9 * wrap_rad(s.yaw_rad - lag(s.yaw_rad) OVER (PARTITION BY st.drive_id, st.ego_id, st.seg ORDER BY st.t_ns)))::BIGINT AS turned,
        st.t_ns - min(st.t_ns) OVER (PARTITION BY st.drive_id, st.ego_id, st.seg) AS age_ns,
        CASE WHEN q.actor_id IS NULL THEN filter_half_ns(c.period_ns) END AS half_ns
    FROM step st
    JOIN clock c USING (drive_id, ego_id)
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN (SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'velocity_filtered') q ON q.drive_id = st.drive_id AND q.actor_id = st.ego_id
),
unwrapped AS (
    SELECT
        * EXCLUDE (yaw, turned),
        CASE WHEN yaw IS NOT NULL THEN sum(coalesce(turned, 0)) OVER (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns ROWS UNBOUNDED PRECEDING) END AS yaw
    FROM sample
),
sloped AS (
    SELECT
        drive_id, ego_id, seg, t_ns, age_ns, v_long_mps, half_ns,
        CASE WHEN whole_window(t_ns, min(t_ns) OVER near, max(t_ns) OVER near, half_ns) THEN
            CASE WHEN count(v) OVER near = count(*) OVER near THEN exact_slope(
                count(*) OVER near, sum(age_ns::HUGEINT) OVER near, sum(v) OVER near, sum(age_ns * v) OVER near, sum(age_ns::HUGEINT * age_ns) OVER near
            ) END
        END AS accel_mps2,
        CASE WHEN whole_window(t_ns, min(t_ns) OVER near, max(t_ns) OVER near, half_ns) THEN
            CASE WHEN count(yaw) OVER near = count(*) OVER near THEN exact_slope(
                count(*) OVER near, sum(age_ns::HUGEINT) OVER near, sum(yaw) OVER near, sum(age_ns * yaw) OVER near, sum(age_ns::HUGEINT * age_ns) OVER near
            ) END
        END AS yaw_rate_radps
    FROM unwrapped
    WINDOW near AS (
        PARTITION BY drive_id, ego_id, seg ORDER BY t_ns
        RANGE BETWEEN coalesce(half_ns, 0) PRECEDING AND coalesce(half_ns, 0) FOLLOWING
    )
),
jerked AS (
    SELECT
        *,
        CASE WHEN whole_window(t_ns, min(t_ns) OVER near, max(t_ns) OVER near, half_ns) THEN
            CASE WHEN count(a) OVER near = count(*) OVER near THEN exact_slope(
                count(*) OVER near, sum(age_ns::HUGEINT) OVER near, sum(a) OVER near, sum(age_ns * a) OVER near, sum(age_ns::HUGEINT * age_ns) OVER near
            ) END
        END AS jerk_mps3
    FROM (SELECT *, round(1e9 * accel_mps2)::HUGEINT AS a FROM sloped)
    WINDOW near AS (
        PARTITION BY drive_id, ego_id, seg ORDER BY t_ns
        RANGE BETWEEN coalesce(half_ns, 0) PRECEDING AND coalesce(half_ns, 0) FOLLOWING
    )
),
-- a mean acceleration is the change of speed over the time: no sample between the ends can alter it
before AS (
    SELECT
        *,
        v_long_mps * yaw_rate_radps AS lat_accel_mps2,
        first_value({'t_ns': t_ns, 'v': v_long_mps}) OVER (w RANGE BETWEEN 2_000_000_000 PRECEDING AND CURRENT ROW) AS at_2s,
        first_value({'t_ns': t_ns, 'a': accel_mps2}) OVER (w RANGE BETWEEN 1_000_000_000 PRECEDING AND CURRENT ROW) AS at_1s,
        first_value({'accel': accel_mps2, 'lat': v_long_mps * yaw_rate_radps}) OVER (w RANGE BETWEEN coalesce(half_ns, 0) PRECEDING AND CURRENT ROW) AS past,
        last_value({'accel': accel_mps2, 'lat': v_long_mps * yaw_rate_radps}) OVER (w RANGE BETWEEN CURRENT ROW AND coalesce(half_ns, 0) FOLLOWING) AS next
    FROM jerked
    WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns)
)
SELECT
    drive_id, ego_id, t_ns, v_long_mps, accel_mps2, lat_accel_mps2, jerk_mps3,
    CASE WHEN half_ns IS NOT NULL AND age_ns >= 2_000_000_000 THEN 1e9 * (v_long_mps - at_2s.v) / (t_ns - at_2s.t_ns) END AS accel_2s_mps2,
    CASE WHEN half_ns IS NOT NULL AND age_ns >= 1_000_000_000 THEN 1e9 * (accel_mps2 - at_1s.a) / (t_ns - at_1s.t_ns) END AS jerk_1s_mps3,
    0.7 * peak_rise(accel_mps2, past.accel, next.accel) AS accel_peak_mps2,
    0.7 * peak_rise(lat_accel_mps2, past.lat, next.lat) AS lat_peak_mps2
FROM before

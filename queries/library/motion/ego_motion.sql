-- The ego's own motion, filtered before it is differentiated. The acceleration is the least-squares slope of v_long_mps over the samples
-- within 0.25 s on either side (2.2 periods if that is more, so always two samples). The yaw rate is the same slope of the heading. At
-- 20 Hz this is a mean over half a second: a spike of one sample appears at a third of its height.
--
-- The jerk is the slope of the acceleration over the samples within 0.7 s on either side. The window is one of time, not of samples, so
-- that the jerk does not depend on the rate of the log. nuPlan differentiates the acceleration with a Savitzky-Golay filter of second order
-- over 15 samples at 10 Hz, which at the middle of its window is this slope (nuPlan devkit, state_extractors, extract_ego_jerk).
--
-- A value is NULL in four cases: the velocity itself comes from a filter (quality velocity_filtered); a sample in the window is not known;
-- the samples do not extend over 0.7 of the half window on both sides (at the log's ends, at a hole); or the log has less than 5 samples a
-- second. In the last case, the mean would be over so long a time that harsh braking disappears.
--
-- A mean over half a second flattens a peak. The *_peak columns are upper bounds of this loss, for a value that is further from zero than
-- both values half a window before and after it (see peak_rise).
--
-- The *_error columns are error bounds. The bound is the greatest of three values. First, three times the mean standard error of the slopes
-- over two seconds (the deviation of the samples from their lines: short when the motion changes, constant in noise). Second, twice the
-- greatest standard error nearby. Third, the contradiction by another measurement of the same motion: positions for the acceleration,
-- course for the yaw rate. Where the value itself is NULL, its bound means nothing.
--
-- For an ego that was measured by the sensors of another vehicle, the bound is at least the effect of a position error of 0.1 m, or of a
-- speed that contradicts the positions. The values of such an ego are not trusted if it accelerates faster than an engine can, or within a
-- second of a change that tyres cannot cause or of sliding sideways.
--
-- The sums are of whole numbers (v in nm/s, yaw in nrad, time in ns) and therefore exact: the same in any order, whatever other drives are
-- in the table.
-- lifetime: part
CREATE TABLE ego_motion (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    v_long_mps DOUBLE,                -- speed along the ego's own heading; negative: reversing {velocity}
    accel_mps2 DOUBLE,                -- longitudinal acceleration, least-squares over 0.25 s on both sides; NULL: incomplete window (ends of the log, holes), or below 5 Hz {velocity}
    lat_accel_mps2 DOUBLE,            -- lateral acceleration, left positive: speed times smoothed yaw rate {velocity}
    jerk_mps3 DOUBLE,                 -- slope of accel_mps2 over 0.7 s on both sides, at every sampling rate {velocity}
    accel_2s_mps2 DOUBLE,             -- mean acceleration over the 2 s that end at this step {velocity}
    jerk_1s_mps3 DOUBLE,              -- mean jerk over the 1 s that ends at this step {velocity}
    accel_peak_mps2 DOUBLE NOT NULL,  -- how much further from zero the true longitudinal acceleration may be (also when braking), because the filter flattens peaks {velocity}
    lat_peak_mps2 DOUBLE NOT NULL,    -- how much further from zero the true lateral acceleration may be, as accel_peak_mps2 {velocity}
    accel_error_mps2 DOUBLE,          -- error bound of the longitudinal acceleration, from the scatter of the speeds or a contradiction by the positions; without meaning where accel_mps2 is NULL {velocity}
    lat_error_mps2 DOUBLE,            -- error bound of the lateral acceleration, from the scatter of the headings or a contradiction by the course; without meaning where lat_accel_mps2 is NULL {velocity}
    jerk_error_mps3 DOUBLE,           -- error bound of the jerk {velocity}
    jerk_1s_error_mps3 DOUBLE         -- error bound of the mean jerk over 1 s {velocity}
);

INSERT INTO ego_motion BY NAME
WITH chosen AS (
    SELECT drive_id, list(actor_id) FILTER (check_id = 'ego_chosen') AS by_user, list(actor_id) FILTER (check_id = 'egos_chosen') AS of_recorder, bool_or(check_id = 'egos_chosen') AS are_all
    FROM quality WHERE check_id IN ('ego_chosen', 'egos_chosen') GROUP BY drive_id
),
sample AS (
    SELECT
        st.drive_id, st.ego_id, st.seg, st.t_ns,
        s.vx_mps * cos(s.yaw_rad) + s.vy_mps * sin(s.yaw_rad) AS v_long_mps,
        round(1e9 * (s.vx_mps * cos(s.yaw_rad) + s.vy_mps * sin(s.yaw_rad)))::HUGEINT AS v,
        round(1e9 * s.yaw_rad)::BIGINT AS yaw,
        round(1e9 * wrap_rad(s.yaw_rad - lag(s.yaw_rad) OVER w))::BIGINT AS turned,
        round(1e18 * ((lead(s.x_m) OVER w - lag(s.x_m) OVER w) * cos(s.yaw_rad) + (lead(s.y_m) OVER w - lag(s.y_m) OVER w) * sin(s.yaw_rad)) / nullif(lead(s.t_ns) OVER w - lag(s.t_ns) OVER w, 0))::HUGEINT AS v_of_places,
        round(1e9 * course.rad)::BIGINT AS course,
        round(1e9 * wrap_rad(course.rad - lag(course.rad) OVER w))::BIGINT AS course_turned,
        st.t_ns - min(st.t_ns) OVER (PARTITION BY st.drive_id, st.ego_id, st.seg) AS age_ns,
        CASE WHEN q.actor_id IS NULL THEN filter_half_ns(c.period_ns) END AS half_ns,
        g.sensor_range_m IS NOT NULL AND coalesce(CASE WHEN o.are_all THEN NOT coalesce(list_contains(o.of_recorder, st.ego_id), false) ELSE list_contains(o.by_user, st.ego_id) END, false) AS is_measured,
        -- also while it reverses
        coalesce(s.speed_mps > 5.0 AND abs(sin(course.rad - s.yaw_rad)) > sin(slides_rad()), false) AS slides,
        EXISTS (FROM doubt d WHERE d.drive_id = st.drive_id AND d.actor_id = st.ego_id AND d.quantity = 'velocity' AND st.t_ns BETWEEN d.t_from_ns AND d.t_to_ns) AS is_doubted
    FROM step st
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g ON g.drive_id = st.drive_id
    LEFT JOIN chosen o ON o.drive_id = st.drive_id
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN (SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'velocity_filtered') q ON q.drive_id = st.drive_id AND q.actor_id = st.ego_id
    -- An ego that hardly moves has no course.
    CROSS JOIN LATERAL (SELECT CASE WHEN s.speed_mps > 2.0 THEN atan2(s.vy_mps, s.vx_mps) END AS rad) course
    WINDOW w AS (PARTITION BY st.drive_id, st.ego_id, st.seg ORDER BY st.t_ns)
),
unwrapped_sample AS (
    SELECT
        * EXCLUDE (yaw, turned, course, course_turned),
        CASE WHEN yaw IS NOT NULL THEN sum(coalesce(turned, 0)) OVER w END AS yaw,
        CASE WHEN course IS NOT NULL THEN sum(coalesce(course_turned, 0)) OVER w END AS course
    FROM sample
    WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns ROWS UNBOUNDED PRECEDING)
),
slope_sample AS (
    SELECT
        drive_id, ego_id, seg, t_ns, age_ns, v_long_mps, half_ns, is_measured, slides, is_doubted, abs(avg(v - v_of_places) OVER near) / (2 * half_ns) AS off_places_mps2,
        CASE WHEN whole_window(t_ns, min(t_ns) OVER near, max(t_ns) OVER near, half_ns) THEN
            CASE WHEN count(v) OVER near = count(*) OVER near THEN exact_slope(
                count(*) OVER near, sum(age_ns::HUGEINT) OVER near, sum(v) OVER near, sum(age_ns * v) OVER near, sum(age_ns::HUGEINT * age_ns) OVER near
            ) END
        END AS accel_mps2,
        CASE WHEN whole_window(t_ns, min(t_ns) OVER near, max(t_ns) OVER near, half_ns) THEN
            CASE WHEN count(yaw) OVER near = count(*) OVER near THEN exact_slope(
                count(*) OVER near, sum(age_ns::HUGEINT) OVER near, sum(yaw) OVER near, sum(age_ns * yaw) OVER near, sum(age_ns::HUGEINT * age_ns) OVER near
            ) END
        END AS yaw_rate_radps,
        line_through(count(v) OVER near, sum(age_ns::HUGEINT) FILTER (v IS NOT NULL) OVER near, sum(v) OVER near, sum(age_ns * v) OVER near, sum(age_ns::HUGEINT * age_ns) FILTER (v IS NOT NULL) OVER near, sum(v * v) OVER near) AS v_line,
        line_through(count(yaw) OVER near, sum(age_ns::HUGEINT) FILTER (yaw IS NOT NULL) OVER near, sum(yaw) OVER near, sum(age_ns * yaw) OVER near, sum(age_ns::HUGEINT * age_ns) FILTER (yaw IS NOT NULL) OVER near, sum(yaw::HUGEINT * yaw) OVER near) AS yaw_line,
        line_through(count(v_of_places) OVER near, sum(age_ns::HUGEINT) FILTER (v_of_places IS NOT NULL) OVER near, sum(v_of_places) OVER near, sum(age_ns * v_of_places) OVER near, sum(age_ns::HUGEINT * age_ns) FILTER (v_of_places IS NOT NULL) OVER near, sum(v_of_places * v_of_places) OVER near) AS place_line,
        line_through(count(course) OVER near, sum(age_ns::HUGEINT) FILTER (course IS NOT NULL) OVER near, sum(course) OVER near, sum(age_ns * course) OVER near, sum(age_ns::HUGEINT * age_ns) FILTER (course IS NOT NULL) OVER near, sum(course::HUGEINT * course) OVER near) AS course_line
    FROM unwrapped_sample
    WINDOW near AS (
        PARTITION BY drive_id, ego_id, seg ORDER BY t_ns
        RANGE BETWEEN coalesce(half_ns, 0) PRECEDING AND coalesce(half_ns, 0) FOLLOWING
    )
),
jerk_sample AS (
    SELECT
        *,
        CASE WHEN whole_jerk_window(t_ns, min(t_ns) OVER near, max(t_ns) OVER near) THEN
            CASE WHEN count(a) OVER near = count(*) OVER near THEN exact_slope(
                count(*) OVER near, sum(age_ns::HUGEINT) OVER near, sum(a) OVER near, sum(age_ns * a) OVER near, sum(age_ns::HUGEINT * age_ns) OVER near
            ) END
        END AS jerk_mps3,
        CASE WHEN abs(accel_mps2) > tyre_mps2() OR is_measured AND (accel_mps2 > engine_mps2() OR max(abs(accel_mps2)) OVER near_noise > tyre_mps2() OR bool_or(slides) OVER near_noise) THEN 'inf'::DOUBLE
            ELSE greatest(CASE WHEN is_measured THEN greatest(measured_mps2(), off_places_mps2) END, 3e-9 * avg(round(1e9 * v_line.error)::HUGEINT) OVER near_noise, 2 * max(v_line.error) OVER just_here, contradiction(accel_mps2, place_line.slope, place_line.error)) END AS accel_error_mps2,
        CASE WHEN abs(v_long_mps * yaw_rate_radps) > tyre_mps2() THEN 'inf'::DOUBLE
            ELSE greatest(CASE WHEN is_measured THEN measured_mps2() END, abs(v_long_mps) * greatest(3e-9 * avg(round(1e9 * yaw_line.error)::HUGEINT) OVER near_noise, 2 * max(yaw_line.error) OVER just_here, contradiction(yaw_rate_radps, course_line.slope, course_line.error))) END AS lat_error_mps2
    FROM (SELECT *, round(1e9 * accel_mps2)::HUGEINT AS a FROM slope_sample)
    WINDOW near AS (
        PARTITION BY drive_id, ego_id, seg ORDER BY t_ns
        RANGE BETWEEN jerk_half_ns() PRECEDING AND jerk_half_ns() FOLLOWING
    ), near_noise AS (
        PARTITION BY drive_id, ego_id, seg ORDER BY t_ns
        RANGE BETWEEN 1_000_000_000 PRECEDING AND 1_000_000_000 FOLLOWING
    ), just_here AS (
        PARTITION BY drive_id, ego_id, seg ORDER BY t_ns
        RANGE BETWEEN coalesce(half_ns, 0) PRECEDING AND coalesce(half_ns, 0) FOLLOWING
    )
),
-- A mean acceleration is the change of speed divided by the time: samples between the two ends cannot alter it.
window_sample AS (
    SELECT
        *,
        v_long_mps * yaw_rate_radps AS lat_accel_mps2,
        -- The engine doubts a mean by the doubts at its last step. The doubt at its first step is applied here.
        first_value({'t_ns': t_ns, 'v': CASE WHEN NOT is_doubted THEN v_long_mps END}) OVER (w RANGE BETWEEN 2_000_000_000 PRECEDING AND CURRENT ROW) AS at_2s,
        first_value({'t_ns': t_ns, 'a': accel_mps2, 'error': accel_error_mps2}) OVER (w RANGE BETWEEN 1_000_000_000 PRECEDING AND CURRENT ROW) AS at_1s,
        first_value({'accel': accel_mps2, 'lat': v_long_mps * yaw_rate_radps}) OVER (w RANGE BETWEEN coalesce(half_ns, 0) PRECEDING AND CURRENT ROW) AS half_window_before,
        last_value({'accel': accel_mps2, 'lat': v_long_mps * yaw_rate_radps}) OVER (w RANGE BETWEEN CURRENT ROW AND coalesce(half_ns, 0) FOLLOWING) AS half_window_after
    FROM jerk_sample
    WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns)
)
SELECT
    drive_id, ego_id, t_ns, v_long_mps, accel_mps2, lat_accel_mps2, jerk_mps3,
    CASE WHEN half_ns IS NOT NULL AND age_ns >= 2_000_000_000 THEN 1e9 * (v_long_mps - at_2s.v) / (t_ns - at_2s.t_ns) END AS accel_2s_mps2,
    CASE WHEN half_ns IS NOT NULL AND age_ns >= 1_000_000_000 THEN 1e9 * (accel_mps2 - at_1s.a) / (t_ns - at_1s.t_ns) END AS jerk_1s_mps3,
    0.7 * peak_rise(accel_mps2, half_window_before.accel, half_window_after.accel) AS accel_peak_mps2,
    0.7 * peak_rise(lat_accel_mps2, half_window_before.lat, half_window_after.lat) AS lat_peak_mps2,
    accel_error_mps2, lat_error_mps2,
    -- The error of the jerk: the acceleration is wrong at one end of the window.
    1e9 * accel_error_mps2 / (2 * jerk_half_ns()) AS jerk_error_mps3,
    CASE WHEN age_ns >= 1_000_000_000 THEN 1e9 * sqrt(accel_error_mps2 ** 2 + at_1s.error ** 2) / (t_ns - at_1s.t_ns) END AS jerk_1s_error_mps3
FROM window_sample

-- A state holds until the next sample. A light that was recorded all the time and then no more is not known from there on; one that was
-- recorded at its changes is.
WITH sample AS (
    SELECT
        drive_id, signal_id, t_ns,
        -- two states at one time are none
        CASE WHEN count(state) = count(*) AND min(state) = max(state) THEN min(state) END AS state
    FROM signal_state
    GROUP BY drive_id, signal_id, t_ns
),
spaced AS (
    SELECT *, lead(t_ns) OVER w - t_ns AS gap_ns, lead(state) OVER w IS NOT DISTINCT FROM state AS goes_on FROM sample
    WINDOW w AS (PARTITION BY drive_id, signal_id ORDER BY t_ns)
),
-- one that says the same again and again is recorded all the time; amber after a second is a change
cadence AS (
    SELECT drive_id, signal_id, (max_gap_periods() * quantile_disc(gap_ns, 0.5))::BIGINT AS max_gap_ns
    FROM spaced
    WHERE goes_on
    GROUP BY drive_id, signal_id
    HAVING quantile_disc(gap_ns, 0.5) <= 1_000_000_000
),
known AS (
    SELECT drive_id, signal_id, t_ns, state FROM sample
    UNION ALL
    SELECT s.drive_id, s.signal_id, s.t_ns + c.max_gap_ns + 1, NULL
    FROM spaced s
    JOIN cadence c USING (drive_id, signal_id)
    WHERE s.gap_ns IS NULL OR s.gap_ns > c.max_gap_ns
),
changed AS (
    SELECT *
    FROM known
    WINDOW w AS (PARTITION BY drive_id, signal_id ORDER BY t_ns)
    QUALIFY row_number() OVER w = 1 OR state IS DISTINCT FROM lag(state) OVER w
)
SELECT drive_id, signal_id, t_ns AS t_from_ns, lead(t_ns) OVER (PARTITION BY drive_id, signal_id ORDER BY t_ns) AS t_to_ns, state
FROM changed

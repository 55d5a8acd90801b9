-- The phases of every light: a state applies until the next sample. If a light was recorded continuously and then not, its state is not
-- known from then on. If it was recorded only at its changes, its last state still applies.
-- lifetime: part
CREATE TABLE _signal_phase (
    drive_id VARCHAR NOT NULL,        -- the drive
    signal_id VARCHAR NOT NULL,       -- see signal_state
    t_from_ns BIGINT NOT NULL,        -- start of the phase
    t_to_ns BIGINT,                   -- end of the phase (excluded); NULL: no end
    state VARCHAR                     -- [light_state] see signal_state; NULL: not known, as after the last sample of a light that was recorded at least once a second
);

INSERT INTO _signal_phase BY NAME
WITH state_sample AS (
    SELECT
        drive_id, signal_id, t_ns,
        -- Two different states at one time count as not known.
        CASE WHEN count(state) = count(*) AND min(state) = max(state) THEN min(state) END AS state
    FROM signal_state
    GROUP BY drive_id, signal_id, t_ns
),
sample_spacing AS (
    SELECT *, lead(t_ns) OVER w - t_ns AS gap_ns, lead(state) OVER w IS NOT DISTINCT FROM state AS is_repeated FROM state_sample
    WINDOW w AS (PARTITION BY drive_id, signal_id ORDER BY t_ns)
),
-- A light that repeats the same state is recorded continuously. Amber after a second is a change, not a repetition.
repeat_period AS (
    SELECT drive_id, signal_id, (max_gap_periods() * quantile_disc(gap_ns, 0.5))::BIGINT AS max_gap_ns
    FROM sample_spacing
    WHERE is_repeated
    GROUP BY drive_id, signal_id
    HAVING quantile_disc(gap_ns, 0.5) <= 1_000_000_000
),
known_state AS (
    -- If a sample lies within a lost stretch, the next change may be lost, too.
    SELECT k.drive_id, k.signal_id, k.t_ns, CASE WHEN l.t_to_ns > k.t_ns THEN NULL ELSE k.state END AS state
    FROM state_sample k
    ASOF LEFT JOIN lost_time l ON l.drive_id = k.drive_id AND l.t_from_ns < k.t_ns
    UNION ALL
    SELECT s.drive_id, s.signal_id, s.t_ns + c.max_gap_ns + 1, NULL
    FROM sample_spacing s
    JOIN repeat_period c USING (drive_id, signal_id)
    -- If a gap is longer by 1 ns, the sample after it is at exactly that time.
    WHERE s.gap_ns IS NULL OR s.gap_ns > c.max_gap_ns + 1
    UNION ALL
    -- A change may be in the lost part of the log.
    SELECT DISTINCT s.drive_id, s.signal_id, l.t_from_ns + 1, NULL
    FROM state_sample s
    JOIN lost_time l USING (drive_id)
    ANTI JOIN state_sample k ON k.drive_id = s.drive_id AND k.signal_id = s.signal_id AND k.t_ns = l.t_from_ns + 1
    WHERE l.t_from_ns > -9_000_000_000_000_000_000
),
state_change AS (
    SELECT *
    FROM known_state
    WINDOW w AS (PARTITION BY drive_id, signal_id ORDER BY t_ns)
    QUALIFY row_number() OVER w = 1 OR state IS DISTINCT FROM lag(state) OVER w
)
SELECT drive_id, signal_id, t_ns AS t_from_ns, lead(t_ns) OVER (PARTITION BY drive_id, signal_id ORDER BY t_ns) AS t_to_ns, state
FROM state_change

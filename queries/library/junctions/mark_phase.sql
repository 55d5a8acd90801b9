-- The state that the lights of a junction, stop line or crossing on the ego's chain (a mark, see way_mark) show for the ego's turn. Several
-- heads count as one if they agree; otherwise the state is not known.
-- lifetime: part
CREATE TABLE mark_phase (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- see way_mark
    kind VARCHAR NOT NULL,            -- [mark_kind] see way_mark
    mark_id VARCHAR NOT NULL,         -- see way_mark
    s_start_m DOUBLE NOT NULL,        -- see way_mark
    t_from_ns BIGINT NOT NULL,        -- start of the phase
    t_to_ns BIGINT,                   -- end of the phase (excluded); NULL: no end
    state VARCHAR,                    -- [light_state] the state that the lights show for the ego's turn, see signal_state: that of its arrow, or of the full light if the arrow is dark; NULL: not known, or the heads that may be for this turn differ
    state_before VARCHAR,             -- [light_state] the state before this phase; NULL: not known
    begin_seen BOOLEAN NOT NULL,      -- both states are known: the change was seen
    t_before_ns BIGINT                -- start of the state before; NULL: not seen
);

INSERT INTO mark_phase BY NAME
WITH signal_head AS (
    SELECT
        m.drive_id, m.ego_id, m.chain_id, m.kind, m.mark_id, m.s_start_m, m.light.signal_id, m.light.fit, r.signal_id IS NOT NULL AS is_recorded,
        -- An arrow for the ego's turn has priority over a full light. If it is not certain that the arrow is for that turn, both must show
        -- the same state.
        CASE WHEN m.light.fit IN ('own', 'maybe') OR bool_or(m.light.fit = 'maybe') OVER w OR NOT bool_or(m.light.fit = 'own') OVER w THEN 1 ELSE 2 END AS tier
    FROM (SELECT * EXCLUDE (lights), unnest(lights) AS light FROM way_mark) m
    LEFT JOIN (SELECT DISTINCT drive_id, signal_id FROM _signal_phase) r ON r.drive_id = m.drive_id AND r.signal_id = m.light.signal_id
    WHERE m.light.fit <> 'other'
    WINDOW w AS (PARTITION BY m.drive_id, m.ego_id, m.chain_id, m.kind, m.mark_id, m.s_start_m)
),
-- A head that is not recorded has the state of another head, if both are certainly for the same turns.
used_head AS (
    SELECT *
    FROM signal_head
    WINDOW w AS (PARTITION BY drive_id, ego_id, chain_id, kind, mark_id, s_start_m, tier)
    QUALIFY is_recorded OR NOT (bool_or(is_recorded) OVER w AND min(fit) OVER w = max(fit) OVER w AND fit IN ('own', 'full'))
),
phase_start AS (
    SELECT DISTINCT h.drive_id, h.ego_id, h.chain_id, h.kind, h.mark_id, h.s_start_m, p.t_from_ns AS t_ns
    FROM used_head h
    JOIN _signal_phase p USING (drive_id, signal_id)
),
state_by_priority AS (
    SELECT
        o.drive_id, o.ego_id, o.chain_id, o.kind, o.mark_id, o.s_start_m, o.t_ns, h.tier,
        CASE WHEN count(p.state) = count(*) AND min(p.state) = max(p.state) THEN min(p.state) END AS state
    FROM phase_start o
    JOIN used_head h USING (drive_id, ego_id, chain_id, kind, mark_id, s_start_m)
    ASOF LEFT JOIN _signal_phase p ON p.drive_id = h.drive_id AND p.signal_id = h.signal_id AND p.t_from_ns <= o.t_ns
    GROUP BY o.drive_id, o.ego_id, o.chain_id, o.kind, o.mark_id, o.s_start_m, o.t_ns, h.tier
),
shown_state AS (
    SELECT
        drive_id, ego_id, chain_id, kind, mark_id, s_start_m, t_ns,
        -- If the arrow is dark, the full light applies.
        CASE
            WHEN any_value(state) FILTER (tier = 1) = 'off' AND count(*) FILTER (tier = 2) > 0 THEN any_value(state) FILTER (tier = 2)
            ELSE any_value(state) FILTER (tier = 1)
        END AS state
    FROM state_by_priority
    GROUP BY drive_id, ego_id, chain_id, kind, mark_id, s_start_m, t_ns
),
state_change AS (
    SELECT *, lag(state) OVER w AS previous_state
    FROM shown_state
    WINDOW w AS (PARTITION BY drive_id, ego_id, chain_id, kind, mark_id, s_start_m ORDER BY t_ns)
    QUALIFY row_number() OVER w = 1 OR state IS DISTINCT FROM previous_state
)
SELECT
    drive_id, ego_id, chain_id, kind, mark_id, s_start_m, t_ns AS t_from_ns, lead(t_ns) OVER w AS t_to_ns, state, previous_state AS state_before,
    previous_state IS NOT NULL AND state IS NOT NULL AS begin_seen, CASE WHEN lag(previous_state) OVER w IS NOT NULL THEN lag(t_ns) OVER w END AS t_before_ns
FROM state_change
WINDOW w AS (PARTITION BY drive_id, ego_id, chain_id, kind, mark_id, s_start_m ORDER BY t_ns)

-- The class of every actor, as shown by its recorded class, its box and its motion. An actor of class object that moves may be any road
-- user. Only one that stands in the whole log is certainly no road user.
-- lifetime: part
CREATE TABLE road_user (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    actor_class VARCHAR,              -- [actor_class] the class, as far as known: the recorded class; vehicle also for an actor without a class, or of class object and not standing, that is longer than 3 m; object only for an actor that stays within 1 m in the whole log (within 0.5 m for each second of a track of less than 2 s); NULL: it may be any class {class}
    length_m DOUBLE,                  -- box length {size}
    width_m DOUBLE                    -- box width {size}
);

INSERT INTO road_user BY NAME
WITH unclassified_actor AS (FROM actor WHERE actor_class IS NULL OR actor_class = 'object'),
actor_motion AS (
    SELECT
        s.drive_id, s.actor_id,
        greatest(max(s.x_m) - min(s.x_m), max(s.y_m) - min(s.y_m)) > least(standing_spread_m(), standing_mps() * (max(s.t_ns) - min(s.t_ns)) / 1e9) AS has_moved
    FROM actor_state s
    SEMI JOIN unclassified_actor u ON u.drive_id = s.drive_id AND u.actor_id = s.actor_id
    GROUP BY s.drive_id, s.actor_id
)
SELECT
    a.drive_id, a.actor_id,
    CASE
        WHEN u.actor_id IS NULL THEN a.actor_class
        WHEN a.actor_class = 'object' AND NOT w.has_moved THEN 'object'
        WHEN a.length_m > longest_animal_m() THEN 'vehicle'
    END AS actor_class,
    a.length_m, a.width_m
FROM actor a
LEFT JOIN unclassified_actor u USING (drive_id, actor_id)
LEFT JOIN actor_motion w USING (drive_id, actor_id)

-- What the tables of an evaluation contain: steps, subjects, holes, egos that do not drive automatically all the time, sensor ranges.
SELECT
    (SELECT count(*) FROM step), (SELECT count(*) FROM _subject), EXISTS (FROM _segment WHERE seg > 0), EXISTS (FROM _watched),
    EXISTS (FROM data_log WHERE sensor_range_m IS NOT NULL)

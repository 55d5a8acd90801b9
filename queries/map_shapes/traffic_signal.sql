-- The place of a sign or signal.
UPDATE traffic_signal SET geom = ST_Point(x_m, y_m)

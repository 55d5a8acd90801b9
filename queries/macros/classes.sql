-- What an actor may be. A class that is not known (NULL) may be any, and `vehicle` any vehicle: both make a comparison unknown, not false.

-- A box longer than this is no bicycle, and nobody on foot nor an animal if it is longer than that.
CREATE OR REPLACE MACRO longest_bicycle_m() AS 2.5;
CREATE OR REPLACE MACRO longest_alive_m() AS 3.0;
-- What keeps within this in the whole log stands: positions of things that stand jitter.
CREATE OR REPLACE MACRO stays_m() AS 1.0;

-- Could be driven: everything that is not known to be on foot, an animal or a thing.
CREATE OR REPLACE MACRO may_be_vehicle(actor_class) AS coalesce(actor_class NOT IN ('pedestrian', 'animal', 'object'), true);
-- Whether it is driven; unknown for one whose class is not known.
CREATE OR REPLACE MACRO is_vehicle(actor_class) AS actor_class NOT IN ('pedestrian', 'animal', 'object');
-- Whether an actor is of this class; unknown for one whose class is not known, and for a vehicle of unsaid kind where the class is a kind of vehicle.
CREATE OR REPLACE MACRO is_class(actor_class, word) AS CASE
    WHEN actor_class = 'vehicle' THEN CASE WHEN word IN ('pedestrian', 'animal', 'object') THEN false END ELSE actor_class = word END;
-- Whether it is a bicycle; by its length where its class does not say.
CREATE OR REPLACE MACRO is_bicycle(actor_class, length_m) AS
    coalesce(is_class(actor_class, 'bicycle'), CASE WHEN length_m > longest_bicycle_m() THEN false END);
-- Could be on foot.
CREATE OR REPLACE MACRO may_walk(actor_class) AS coalesce(is_class(actor_class, 'pedestrian'), true);
-- Could be driven, or is a thing that stands in the ego's way: their middles are d apart across the road, their half widths are half_m together.
CREATE OR REPLACE MACRO may_be_ahead(actor_class, d_m, half_m) AS may_be_vehicle(actor_class) OR actor_class = 'object' AND abs(d_m) < half_m;

-- The classes that an actor may have. A class that is not known (NULL) may be any class, and `vehicle` may be any kind of vehicle: a
-- comparison with either is unknown, not false.

-- A box longer than longest_bicycle_m is no bicycle. A box longer than longest_animal_m is neither a pedestrian nor an animal.
CREATE OR REPLACE MACRO longest_bicycle_m() AS 2.5;
CREATE OR REPLACE MACRO longest_animal_m() AS 3.0;

-- Whether an actor may be a vehicle: true unless it is known to be a pedestrian, an animal or an object.
CREATE OR REPLACE MACRO may_be_vehicle(actor_class) AS coalesce(actor_class NOT IN ('pedestrian', 'animal', 'object'), true);
-- Whether an actor is a vehicle; unknown if its class is not known.
CREATE OR REPLACE MACRO is_vehicle(actor_class) AS actor_class NOT IN ('pedestrian', 'animal', 'object');
-- Whether an actor is of the class `word`; unknown if its class is not known, or if it is a vehicle of unknown kind and `word` is a kind of
-- vehicle.
CREATE OR REPLACE MACRO is_class(actor_class, word) AS CASE
    WHEN actor_class = 'vehicle' THEN CASE WHEN word IN ('pedestrian', 'animal', 'object') THEN false END ELSE actor_class = word END;
-- Whether an actor is a bicycle. Its length decides if its class does not.
CREATE OR REPLACE MACRO is_bicycle(actor_class, length_m) AS
    coalesce(is_class(actor_class, 'bicycle'), CASE WHEN length_m > longest_bicycle_m() THEN false END);
-- Whether an actor may be on foot.
CREATE OR REPLACE MACRO may_walk(actor_class) AS coalesce(is_class(actor_class, 'pedestrian'), true);
-- Whether an actor may be a vehicle, or is an object in the ego's way. d_m is the lateral distance between the two centres, half_m the sum
-- of the two half widths.
CREATE OR REPLACE MACRO may_be_vehicle_or_obstacle(actor_class, d_m, half_m) AS may_be_vehicle(actor_class) OR actor_class = 'object' AND abs(d_m) < half_m;
-- Whether a thing that stands in the whole log is as large as a car, and may be one that is parked. No car is as narrow as
-- narrowest_car_m.
CREATE OR REPLACE MACRO narrowest_car_m() AS 1.2;
CREATE OR REPLACE MACRO may_be_parked_car(length_m, width_m) AS length_m > longest_animal_m() AND width_m > narrowest_car_m();

-- Part of the statements of this folder: the band of the ego's mean speed over the whole drive, stops included.
CASE WHEN ego.hours > 0 THEN CASE WHEN ego.km / ego.hours < 15 THEN '0 to 15 km/h' WHEN ego.km / ego.hours < 30 THEN '15 to 30 km/h'
    WHEN ego.km / ego.hours < 60 THEN '30 to 60 km/h' WHEN ego.km / ego.hours < 90 THEN '60 to 90 km/h' ELSE '90 km/h and more' END END

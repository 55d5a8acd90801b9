-- How many findings have a place on the earth, and between which degrees.
SELECT count(*) AS findings, count(lon) AS placed, min(lon) AS west, max(lon) AS east, min(lat) AS south, max(lat) AS north FROM counted_findings

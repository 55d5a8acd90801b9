-- The drives that get a page of their own, numbered: those with findings as the fleet page ranks them, at most `$most`; if that is NULL all of
-- them, and behind them the others.
CREATE OR REPLACE TEMP TABLE page_drive AS
SELECT row_number() OVER (ORDER BY r.no NULLS LAST, d.log, d.key) AS no, d.key
FROM drives d LEFT JOIN ({ranked}) r ON r.key = d.key
WHERE $most IS NULL OR r.no <= $most
ORDER BY no

-- The results that get a page of their own, numbered: those that findings of the fleet page are of, for at most `$most` drives as it ranks
-- them; if that is NULL all of them, and behind them the others.
CREATE OR REPLACE TEMP TABLE page_drive AS
SELECT row_number() OVER (ORDER BY r.no NULLS LAST, d.log, d.key) AS no, d.key
FROM drives d
LEFT JOIN (SELECT DISTINCT f.result_key, w.no FROM counted_findings f JOIN ({ranked}) w ON w.key = f.key) r ON r.result_key = d.key
WHERE $most IS NULL OR r.no <= $most
ORDER BY no

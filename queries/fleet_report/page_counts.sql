-- How many verdicts of each kind some drives with a page have.
SELECT no, verdict, sum(n)::BIGINT AS n FROM page_verdict WHERE no BETWEEN $first AND $last GROUP BY no, verdict ORDER BY no, verdict

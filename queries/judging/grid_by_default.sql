-- part of `grid.sql`
_base AS (SELECT *, NULL::VARCHAR AS label, true AS applies, NULL::VARCHAR AS why FROM {grid})

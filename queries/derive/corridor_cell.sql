-- Every 16 m grid cell that the bounding box of a corridor segment's strip touches.
WITH box AS (
    SELECT
        drive_id, ego_id, chain_id, seq, k,
        floor((least(x0_m, x1_m) - strip_m() * greatest(abs(ty0), abs(ty1))) / 16)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + strip_m() * greatest(abs(ty0), abs(ty1))) / 16)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - strip_m() * greatest(abs(tx0), abs(tx1))) / 16)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + strip_m() * greatest(abs(tx0), abs(tx1))) / 16)::BIGINT AS iy1
    FROM corridor
),
columns_ AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM box)
SELECT drive_id, ego_id, cell_key(ix, iy) AS cell, chain_id, seq, k
FROM (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM columns_)

-- The rows of a table about the drives with a page, of some of these drives.
SELECT * FROM {table} WHERE no BETWEEN $first AND $last ORDER BY {order}

-- Curvatures of summits (summits.sql): k by height.
WITH windows(height, low, high) AS (VALUES
    ('-1', -1.15, -0.85), ('-0.5', -0.65, -0.35), ('0', -0.15, 0.15), ('0.5', 0.35, 0.65), ('0.75', 0.6, 0.9), ('1', 0.85, 1.15), ('2', 1.85, 2.15), ('3', 2.85, 3.15), ('3 to 5', 3, 5)),
means AS (SELECT study, number, heights, spectrum, H, C, maker, height, printf('%.3f', sum(k * density) / sum(density)) AS k FROM curvatures
    JOIN windows ON x > low AND x < high GROUP BY study, number, heights, height)
SELECT heights, spectrum, H, C, maker,
    coalesce(max(CASE height WHEN '-1' THEN k END), '-') AS '-1', coalesce(max(CASE height WHEN '-0.5' THEN k END), '-') AS '-0.5',
    coalesce(max(CASE height WHEN '0' THEN k END), '-') AS '0', coalesce(max(CASE height WHEN '0.5' THEN k END), '-') AS '0.5',
    coalesce(max(CASE height WHEN '0.75' THEN k END), '-') AS '0.75', coalesce(max(CASE height WHEN '1' THEN k END), '-') AS '1',
    coalesce(max(CASE height WHEN '2' THEN k END), '-') AS '2', coalesce(max(CASE height WHEN '3' THEN k END), '-') AS '3',
    coalesce(max(CASE height WHEN '3 to 5' THEN k END), '-') AS '3 to 5'
FROM means GROUP BY study, number, heights ORDER BY heights, spectrum, H, C, maker;

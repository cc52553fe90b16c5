-- Heights of summits (summits.sql): skewness, density, highest bin, shares of all summits.
WITH shares AS (SELECT study, number, spectrum, H, C, maker, heights, iif(heights = 'maximum', 'pit_', 'summit_') AS side, max(y) AS top, x, error,
    sum((x < -0.5) * y) / sum(y) AS low, sum((x < 0) * y) / sum(y) AS negative, sum((x > 0.8) * y) / sum(y) AS high, sum((x > 1) * y) / sum(y) AS above
    FROM bins WHERE quantity = 'summit_height_pdf' GROUP BY study, number, heights)
SELECT heights, spectrum, H, C, maker, printf('%.3f +- %.3f', s.value, s.standard_error) AS skewness, printf('%.4f +- %.4f', d.value, d.standard_error) AS density,
    printf('%.4f', h.value) AS 'mean height', printf('%.3f +- %.3f', top, error) AS 'highest bin', printf('%.3f', x) AS at,
    printf('%.3f', low) AS 'below -0.5', printf('%.3f', negative) AS 'below 0', printf('%.3f', high) AS 'above 0.8', printf('%.3f', above) AS 'above 1'
FROM shares b JOIN case_scalars s ON s.study = b.study AND s."case" = number AND s.scalar = side || 'height_skewness'
    JOIN case_scalars d ON d.study = b.study AND d."case" = number AND d.scalar = side || 'density'
    JOIN case_scalars h ON h.study = b.study AND h."case" = number AND h.scalar = side || 'height_mean'
ORDER BY heights, spectrum, H, C, maker;

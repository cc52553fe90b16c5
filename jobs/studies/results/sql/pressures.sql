-- Pressures in contact, of the study :name: of each case, load and model the mean over the contact, and the share of the contact
-- that bears more than 1.5 E* h'. The contact is that by edges. Totals are half of 95 % intervals by all errors that are known;
-- that of a share is the sum over its bins.
CREATE TEMP TABLE cases AS
SELECT s.public AS study, p."case" AS number, max(CASE p.value WHEN 'weibull_min' THEN 'minimum' WHEN 'weibull_max' THEN 'maximum' END) AS heights,
    max(CASE p.parameter WHEN '/surface/heights/shape' THEN p.value END) AS C, max(CASE p.parameter WHEN '/surface/hurst' THEN p.value END) AS H
FROM study s JOIN case_parameters p ON p.study = s.public WHERE s.name = :name GROUP BY s.public, p."case";
WITH tails AS (
    SELECT p.study, p."case" AS number, p.model, p.pressure AS load, (max(p.x) - min(p.x)) / (count(*) - 1) AS width, sum((p.x > 1.5) * p.y) AS y,
        sum((p.x > 1.5) * p.standard_error * p.standard_error) AS variance,
        sum((p.x > 1.5) * (coalesce(p.total_high, p.y) - coalesce(p.total_low, p.y))) / 2 AS total
    FROM curve_points p JOIN cases c ON c.study = p.study AND c.number = p."case"
    WHERE p.quantity = 'contact_pressure_pdf' GROUP BY p.study, p."case", p.model, p.pressure)
SELECT t.number AS "case", coalesce(c.heights, 'Gaussian') AS heights, coalesce(c.C, '-') AS C, c.H, t.load, t.model,
    printf('%.4f +- %.4f', t.load / a.y, t.load * a.standard_error / (a.y * a.y)) AS 'mean pressure',
    printf('%.2g', 50 * (a.total_high - a.total_low) / a.y) AS 'total %',
    printf('%.5f +- %.5f', t.width * t.y / a.y, t.width / a.y * sqrt(t.variance + pow(t.y * a.standard_error / a.y, 2))) AS 'above 1.5',
    printf('%.5f', t.width * t.total / a.y) AS total
FROM tails t JOIN cases c ON c.study = t.study AND c.number = t.number JOIN curve_points a ON a.study = t.study AND a."case" = t.number
    AND a.quantity = 'contact_area' AND a.series = 'edges' AND a.model = t.model AND a.level = 8 AND a.x = t.load
ORDER BY t.number, t.load, t.model;

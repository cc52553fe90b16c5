-- Which law a density of summits distinguishes, of the studies whose names are like :names: what the other law gives more in percent, and the
-- surfaces of which 1.96 standard errors are as much, n (1.96 e/d)^2 of n surfaces with the error e and the difference d.
CREATE TEMP TABLE found AS
SELECT s.name, d."case" AS number, d.scalar, d.value, d.law_difference AS d,
    printf('%g', CAST(printf('%.0e', s.realisations_done / s.cases * pow(1.96 * d.standard_error / d.law_difference, 2)) AS REAL)) AS surfaces
FROM study s JOIN case_scalars d ON d.study = s.public WHERE s.name GLOB :names AND d.scalar IN ('summit_density', 'pit_density') AND d.law_difference IS NOT NULL;
SELECT max(CASE p.parameter WHEN '/surface/hurst' THEN p.value END) AS H, max(CASE p.parameter WHEN '/surface/wavelength_ratio' THEN p.value END) AS ratio,
    max(CASE p.parameter WHEN '/surface/heights/shape' THEN p.value END) AS C, printf('%+.1f', 100 * a.d / a.value) AS 'summits, %', a.surfaces,
    printf('%+.1f', 100 * b.d / b.value) AS 'pits, %', b.surfaces
FROM found a JOIN found b ON b.name = a.name AND b.number = a.number AND b.scalar = 'pit_density' JOIN study s ON s.name = a.name
JOIN case_parameters p ON p.study = s.public AND p."case" = a.number WHERE a.scalar = 'summit_density' GROUP BY a.name, a.number;

-- What an error costs, of the studies whose names are like :names: CPU seconds until 1.96 standard errors and what cell, mesh, block and model leave
-- (|value| + bound) are below it together, in all cases at all loads from 0.05 on. The seconds rise as the realisations, these as the inverse square of
-- the standard error. Areas by edges of contact; densities of summits of statistics.
CREATE TEMP TABLE stays AS
SELECT study, "case" AS number, model, level, x, sum(abs(value) + coalesce(bound, 0)) AS stays
FROM curve_errors WHERE quantity = 'contact_area' AND series = 'edges' GROUP BY study, number, model, level, x;
CREATE TEMP TABLE found AS
SELECT s.name, s.cases, s.realisations_done AS n, s.cpu_seconds AS cpu, 196 * p.standard_error / p.y AS random, 100 * coalesce(t.stays, 0) / p.y AS stays
FROM study s JOIN curve_points p ON p.study = s.public
LEFT JOIN stays t ON t.study = p.study AND t.number = p."case" AND t.model IS p.model AND t.level IS p.level AND t.x = p.x
WHERE s.name GLOB :names AND p.quantity = 'contact_area' AND p.series = 'edges' AND p.x >= 0.05
    AND p.level IS (SELECT max(level) FROM curve_points m WHERE m.study = p.study AND m."case" = p."case" AND m.quantity = 'contact_area')
UNION ALL
SELECT s.name, s.cases, s.realisations_done, s.cpu_seconds, 196 * d.standard_error / d.value, 0
FROM study s JOIN case_scalars d ON d.study = s.public WHERE s.name GLOB :names AND s.kind = 'statistics' AND d.scalar = 'summit_density';
SELECT name AS study, cases, n AS realisations, printf('%.3g', max(cpu)) AS 'CPU s', printf('%.2g', max(random)) AS 'random %', printf('%.2g', max(stays)) AS 'that stays %',
    iif(max(stays) < 10, printf('%.3g', max(cpu * pow(random / (10 - stays), 2))), '-') AS '10 %',
    iif(max(stays) < 5, printf('%.3g', max(cpu * pow(random / (5 - stays), 2))), '-') AS '5 %',
    iif(max(stays) < 2, printf('%.3g', max(cpu * pow(random / (2 - stays), 2))), '-') AS '2 %',
    iif(max(stays) < 1, printf('%.3g', max(cpu * pow(random / (1 - stays), 2))), '-') AS '1 %',
    iif(max(stays) < 0.5, printf('%.3g', max(cpu * pow(random / (0.5 - stays), 2))), '-') AS '0.5 %',
    iif(max(stays) < 0.2, printf('%.3g', max(cpu * pow(random / (0.2 - stays), 2))), '-') AS '0.2 %'
FROM found GROUP BY name;

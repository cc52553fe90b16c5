-- What results.list calls by name: v(k, n, v, e), case, name, value, standard error. Scalars have their names; with ".theory" over
-- their theory, with ".grid" what the theory of the grid is over that, with ".difference" their law difference, with ".law" the same in percent. Points of curves
-- are quantity:series:model@x, those of contact on the finest level.
CREATE TEMP VIEW v AS
SELECT "case" AS k, scalar AS n, value AS v, standard_error AS e FROM case_scalars
UNION ALL SELECT "case", scalar || '.theory', value / theory, standard_error / theory FROM case_scalars
UNION ALL SELECT "case", scalar || '.grid', grid_theory / theory, 0 FROM case_scalars
UNION ALL SELECT "case", scalar || '.difference', law_difference, law_standard_error FROM case_scalars
UNION ALL SELECT "case", scalar || '.law', 100 * law_difference / value, 100 * law_standard_error / abs(value) FROM case_scalars
UNION ALL SELECT p."case", quantity || ':' || ifnull(series, '') || ':' || ifnull(model, '') || '@' || round(x, 6), y, standard_error
          FROM curve_points p WHERE level IS NULL OR level = (SELECT max(level) FROM curve_points q WHERE q."case" = p."case");
-- Also d(c, x, s): the standard deviation of the contact area by edges of one realisation, in percent.
CREATE TEMP VIEW d AS
SELECT p."case" AS c, round(x, 6) AS x, 100 * standard_error / y * sqrt((SELECT max(realisations_done) FROM case_progress)) AS s
FROM curve_points p WHERE quantity = 'contact_area' AND series = 'edges';
-- And m(c, x, v, e): what `layered` has more of contact area by edges than `full`, in percent of it, by pairs of realisations.
CREATE TEMP VIEW m AS
SELECT a."case" AS c, round(x, 6) AS x, 100 * avg(a.y - b.y) / avg(b.y) AS v,
       100 * sqrt((avg((a.y - b.y) * (a.y - b.y)) - avg(a.y - b.y) * avg(a.y - b.y)) / (count(*) - 1)) / avg(b.y) AS e
FROM realisation_points a JOIN realisation_points b USING (study, "case", realisation, quantity, series, x)
WHERE quantity = 'contact_area' AND series = 'edges' AND a.model = 'layered' AND b.model = 'full' GROUP BY 1, 2;
-- And l(n, a, b, v, e): by how many percent a point of a curve is larger in case a than in case b, of other realisations.
CREATE TEMP VIEW l AS
SELECT n, a.k AS a, b.k AS b, 100 * (a.v / b.v - 1) AS v, 100 * sqrt(a.e * a.e / a.v / a.v + b.e * b.e / b.v / b.v) AS e
FROM v a JOIN v b USING (n);

-- Findings of the reference on summits of Weibull surfaces, from the studies of a store whose names are like :names. A study made by another iteration or
-- law than the default ends in its name.
-- The minimum is what studies make; summits of the maximum are the pits. k is the mean curvature over sqrt(m4) of summits within 0.15 of a height.
CREATE TEMP TABLE made AS
SELECT s.public AS study, s.name, p."case" AS number,
    CASE WHEN s.name LIKE '%translation' THEN 'translation' WHEN s.name LIKE '%plain' THEN 'plain' ELSE 'reflections' END AS maker,
    max(CASE p.parameter WHEN '/surface/hurst' THEN p.value END) AS H, max(CASE p.parameter WHEN '/surface/heights/shape' THEN p.value END) AS C,
    coalesce(max(CASE p.parameter WHEN '/surface/nayak_alpha' THEN 'alpha ' || p.value END),
             max(CASE p.parameter WHEN '/surface/wavelength_ratio' THEN 'ratio ' || p.value END)) AS spectrum
FROM study s JOIN case_parameters p ON p.study = s.public WHERE s.name GLOB :names GROUP BY s.public, p."case";
CREATE TEMP TABLE bins AS
SELECT m.*, CASE c.series WHEN 'pits' THEN 'maximum' ELSE 'minimum' END AS heights, c.quantity, c.x, c.y, c.standard_error AS error
FROM made m JOIN curve_points c ON c.study = m.study AND c."case" = m.number WHERE c.quantity IN ('summit_height_pdf', 'summit_mean_curvature') AND c.y IS NOT NULL;
CREATE TEMP TABLE curvatures AS -- of each bin of heights, with the density of summits in it
SELECT k.study, k.number, k.maker, k.spectrum, k.H, k.C, k.heights, k.x, k.y AS k, p.y AS density FROM bins k JOIN bins p
    ON p.study = k.study AND p.number = k.number AND p.heights = k.heights AND p.x = k.x AND p.quantity = 'summit_height_pdf'
WHERE k.quantity = 'summit_mean_curvature';

-- Total errors in the views, as schema/result/total.h has them; names that views have alone; a row a case. What an older
-- program published has no totals until it is published anew.
ALTER TABLE scalar ADD COLUMN total_low REAL;
ALTER TABLE scalar ADD COLUMN total_high REAL;
ALTER TABLE scalar ADD COLUMN unknown_errors TEXT; -- sources that the totals leave out, by spaces; NULL: none, or no totals
ALTER TABLE point ADD COLUMN total_low REAL;
ALTER TABLE point ADD COLUMN total_high REAL;
ALTER TABLE point ADD COLUMN unknown_errors TEXT;

DROP VIEW case_scalars;
CREATE VIEW case_scalars AS
    SELECT s.public AS study, c.case_number AS "case", c.name AS scalar, c.value, c.standard_error, c.total_low,
           c.total_high, c.unknown_errors, c.theory, c.grid_theory, c.law_difference, c.law_standard_error
    FROM scalar c JOIN study s ON s.id = c.study_id;
DROP VIEW scalar_errors;
CREATE VIEW scalar_errors AS
    SELECT s.public AS study, e.case_number AS "case", e.name AS scalar, e.source, e.value, e.bound, e.standard_error
    FROM study s JOIN scalar_error e ON e.study_id = s.id;
DROP VIEW curve_points;
CREATE VIEW curve_points AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, p.x, p.y, p.standard_error, p.total_low,
           p.total_high, p.unknown_errors, p.x2, c.model, c.kinematics, c.level, c.pressure,
           coalesce(p.discretisation_error,
                    (SELECT e.value FROM point_error e WHERE e.curve_id = p.curve_id
                     AND e.number = p.number AND e.source = 'discretisation')) AS discretisation_error,
           coalesce(p.model_error,
                    (SELECT e.value FROM point_error e WHERE e.curve_id = p.curve_id
                     AND e.number = p.number AND e.source = 'model')) AS model_error,
           p.valueless, p.law_difference, p.law_standard_error
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id;
DROP VIEW case_parameters;
CREATE VIEW case_parameters AS
    SELECT s.public AS study, c.number AS "case", replace(replace(substr(p.fullkey, 2), '"', ''), '.', '/') AS parameter,
           p.value
    FROM study s JOIN study_case c ON c.study_id = s.id, json_tree(c.parameters) p
    WHERE c.parent IS NULL AND p.type <> 'object' AND typeof(p.key) = 'text';
-- A row a realisation and scalar.
DROP VIEW realisation_scalars;
CREATE VIEW realisation_scalars AS
    SELECT s.public AS study, j.case_number AS "case", j.first + one.key AS realisation, n.value AS scalar,
           json_extract(one.value, '$[' || n.key || ']') AS value
    FROM study s JOIN job j ON j.study_id = s.id JOIN result r ON r.job_id = j.id
    JOIN scalar_names names ON names.id = r.names_id, json_each(r.scalars) one, json_each(names.names) n;
-- A row a case: parameters by their pointers and values of scalars by their names, as JSON.
CREATE VIEW case_table AS
    SELECT p.study, s.name, p."case", p.state, p.realisations_done, c.parameters,
           (SELECT json_group_object(r.name, r.value) FROM scalar r
            WHERE r.study_id = s.id AND r.case_number = c.number) AS scalars
    FROM case_progress p JOIN study s ON s.public = p.study
    JOIN study_case c ON c.study_id = s.id AND c.number = p."case";

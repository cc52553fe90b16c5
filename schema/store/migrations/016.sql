-- What the other law of heights would give: the value under it less the value, and its standard error. NULL: not known.
ALTER TABLE scalar ADD COLUMN law_difference REAL;
ALTER TABLE scalar ADD COLUMN law_standard_error REAL;
ALTER TABLE point ADD COLUMN law_difference REAL;
ALTER TABLE point ADD COLUMN law_standard_error REAL;

DROP VIEW case_scalars;
CREATE VIEW case_scalars AS
    SELECT s.public AS study, c.case_number AS "case", c.name, c.value, c.standard_error, c.theory, c.grid_theory,
           c.law_difference, c.law_standard_error
    FROM scalar c JOIN study s ON s.id = c.study_id;
DROP VIEW curve_points;
CREATE VIEW curve_points AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, p.x, p.y, p.standard_error,
           p.x2, c.model, c.kinematics, c.level, c.pressure,
           coalesce(p.discretisation_error,
                    (SELECT e.value FROM point_error e WHERE e.curve_id = p.curve_id
                     AND e.number = p.number AND e.source = 'discretisation')) AS discretisation_error,
           coalesce(p.model_error,
                    (SELECT e.value FROM point_error e WHERE e.curve_id = p.curve_id
                     AND e.number = p.number AND e.source = 'model')) AS model_error,
           p.valueless, p.law_difference, p.law_standard_error
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id;

-- A published case as parts: its curves one by one as bytes, its report beside them, and errors by
-- source. What an older program published stays as it is: there data and report are null, and all
-- curves are in published.document.
ALTER TABLE curve ADD COLUMN data BLOB;         -- the whole curve (schema/result/curve_bytes.h)
ALTER TABLE published ADD COLUMN report TEXT;   -- of the case, as if it had taken one second
CREATE TABLE point_error (
    curve_id INTEGER NOT NULL REFERENCES curve(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,                    -- of the point
    source TEXT NOT NULL,                       -- "discretisation", "model", ...
    value REAL,
    standard_error REAL,
    PRIMARY KEY (curve_id, number, source)
) WITHOUT ROWID;
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
           p.valueless
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id;
CREATE VIEW curve_errors AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, c.model, c.kinematics,
           c.level, c.pressure, p.x, e.source, e.value, e.standard_error
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id
    JOIN point_error e ON e.curve_id = p.curve_id AND e.number = p.number;

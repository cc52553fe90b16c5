-- Bounds of errors: what is told less what is true lies within value +- bound. Errors of scalars.
ALTER TABLE point_error ADD COLUMN bound REAL;  -- NULL: none is told
CREATE TABLE scalar_error (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    name TEXT NOT NULL,                         -- of the scalar
    source TEXT NOT NULL,
    value REAL,
    bound REAL,
    standard_error REAL,
    PRIMARY KEY (study_id, case_number, name, source)
) WITHOUT ROWID;
DROP VIEW curve_errors;
CREATE VIEW curve_errors AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, c.model, c.kinematics,
           c.level, c.pressure, p.x, e.source, e.value, e.bound, e.standard_error
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id
    JOIN point_error e ON e.curve_id = p.curve_id AND e.number = p.number;
CREATE VIEW scalar_errors AS
    SELECT s.public AS study, e.case_number AS "case", e.name, e.source, e.value, e.bound, e.standard_error
    FROM study s JOIN scalar_error e ON e.study_id = s.id;

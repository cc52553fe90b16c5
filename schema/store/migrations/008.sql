-- Theory of the grid that a scalar was measured on, beside that of surfaces without a grid.
ALTER TABLE scalar ADD COLUMN grid_theory REAL;

DROP VIEW case_scalars;
CREATE VIEW case_scalars AS
    SELECT s.public AS study, c.case_number AS "case", c.name, c.value, c.standard_error, c.theory, c.grid_theory
    FROM scalar c JOIN study s ON s.id = c.study_id;

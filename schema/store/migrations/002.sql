-- Version 2. What is due for publication is asked of one table, and a case that cannot be published
-- says why instead of being tried for ever.
ALTER TABLE study ADD COLUMN cases_failed INTEGER NOT NULL DEFAULT 0; -- those with a publish_error
-- The revision that is published, or that cannot be: a case is due while nothing of it is left to
-- run and its revision is above this.
ALTER TABLE study_case ADD COLUMN settled INTEGER NOT NULL DEFAULT 0;
ALTER TABLE study_case ADD COLUMN publish_error TEXT; -- why revision settled cannot be; null: it is
UPDATE study_case SET settled = coalesce((SELECT p.revision FROM published p WHERE p.study_id =
    study_case.study_id AND p.case_number = number), 0);
CREATE INDEX case_due ON study_case(study_id, number) WHERE jobs_left = 0 AND revision > settled;

-- Stores of version 1 exist that were made before these two had all their columns.
DROP VIEW IF EXISTS curve_points;
CREATE VIEW curve_points AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, p.x, p.y, p.standard_error,
           p.x2, c.model, c.kinematics, c.level, c.pressure, p.discretisation_error, p.model_error,
           p.valueless
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id;
DROP VIEW IF EXISTS case_notes;
CREATE VIEW case_notes AS
    SELECT s.public AS study, p.case_number AS "case", n.value ->> 'realisation' AS realisation,
           n.value ->> 'text' AS note
    FROM study s JOIN published p ON p.study_id = s.id, json_each(p.document, '$.notes.kept') n;

-- state: 'open' jobs are left; 'empty' none is, and no result; 'due'; 'published'; 'failed'.
CREATE VIEW case_progress AS
    SELECT s.public AS study, c.number AS "case",
           CASE WHEN c.jobs_left > 0 THEN 'open' WHEN c.revision = 0 THEN 'empty'
                WHEN c.revision > c.settled THEN 'due' WHEN c.publish_error IS NULL THEN 'published'
                ELSE 'failed' END AS state,
           c.jobs, c.jobs_left, c.realisations_done, s.realisations, c.seconds, c.publish_error AS error
    FROM study s JOIN study_case c ON c.study_id = s.id;

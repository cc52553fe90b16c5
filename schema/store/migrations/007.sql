-- Studies that ask for an error. Each case of such a study is made of components: cases of their
-- own, behind those that were asked for, which run with as many realisations as the error takes.
-- study.realisations of such a study is 0.
ALTER TABLE study_case ADD COLUMN parent INTEGER;       -- of a component: the case it belongs to
ALTER TABLE study_case ADD COLUMN role TEXT;            -- of a component in that case
ALTER TABLE study_case ADD COLUMN sequence INTEGER;     -- of its random numbers; null: the study's rule
ALTER TABLE study_case ADD COLUMN realisations INTEGER; -- of a component: asked for so far
ALTER TABLE study_case ADD COLUMN result_bytes REAL;    -- of a component: of a realisation, as estimated
ALTER TABLE study_case ADD COLUMN error_reached REAL;   -- of a case with components, relative
CREATE INDEX case_parent ON study_case(study_id, parent) WHERE parent IS NOT NULL;

DROP VIEW study_progress;
CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, total AS realisations,
           round(100.0 * realisations_done / total, 1) AS percent, seconds, created, finished, random,
           cpu_seconds, jobs_without_cpu, error_reached
    FROM (SELECT *, CASE WHEN realisations > 0 THEN cases * realisations ELSE
              (SELECT sum(c.realisations) FROM study_case c WHERE c.study_id = study.id) END AS total,
              (SELECT max(c.error_reached) FROM study_case c WHERE c.study_id = study.id) AS error_reached
          FROM study);
DROP VIEW case_progress;
CREATE VIEW case_progress AS
    SELECT s.public AS study, c.number AS "case",
           CASE WHEN c.jobs_left > 0 THEN 'open' WHEN c.revision = 0 THEN 'empty'
                WHEN c.revision > c.settled THEN 'due' WHEN c.publish_error IS NULL THEN 'published'
                ELSE 'failed' END AS state,
           c.jobs, c.jobs_left, c.realisations_done, coalesce(c.realisations, s.realisations) AS realisations,
           c.seconds, c.publish_error AS error, c.cpu_seconds, c.jobs_without_cpu, c.error_reached
    FROM study s JOIN study_case c ON c.study_id = s.id WHERE c.parent IS NULL;
-- What cases that ask for an error are made of.
CREATE VIEW case_components AS
    SELECT s.public AS study, c.parent AS "case", c.number AS component, c.role, c.realisations,
           c.realisations_done, c.jobs, c.jobs_left, c.seconds, c.cpu_seconds, c.parameters
    FROM study s JOIN study_case c ON c.study_id = s.id WHERE c.parent IS NOT NULL;

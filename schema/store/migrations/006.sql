-- Processor time beside time by the clock. What jobs of before took of it is not known.
ALTER TABLE job ADD COLUMN cpu_seconds REAL;    -- NULL: not known
-- Of completed jobs; of those that do not know it, the seconds by the clock. Their number beside it.
ALTER TABLE study ADD COLUMN cpu_seconds REAL NOT NULL DEFAULT 0;
ALTER TABLE study ADD COLUMN jobs_without_cpu INTEGER NOT NULL DEFAULT 0;
ALTER TABLE study_case ADD COLUMN cpu_seconds REAL NOT NULL DEFAULT 0;
ALTER TABLE study_case ADD COLUMN jobs_without_cpu INTEGER NOT NULL DEFAULT 0;
UPDATE study SET cpu_seconds = seconds, jobs_without_cpu = jobs_done;
UPDATE study_case SET cpu_seconds = seconds, jobs_without_cpu =
    (SELECT count(*) FROM job j WHERE j.study_id = study_case.study_id AND j.case_number = number
     AND j.state = 'done');
DROP VIEW study_progress;
CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, cases * realisations AS realisations,
           round(100.0 * realisations_done / (cases * realisations), 1) AS percent, seconds, created, finished,
           random, cpu_seconds, jobs_without_cpu
    FROM study;
DROP VIEW case_progress;
CREATE VIEW case_progress AS
    SELECT s.public AS study, c.number AS "case",
           CASE WHEN c.jobs_left > 0 THEN 'open' WHEN c.revision = 0 THEN 'empty'
                WHEN c.revision > c.settled THEN 'due' WHEN c.publish_error IS NULL THEN 'published'
                ELSE 'failed' END AS state,
           c.jobs, c.jobs_left, c.realisations_done, s.realisations, c.seconds, c.publish_error AS error,
           c.cpu_seconds, c.jobs_without_cpu
    FROM study s JOIN study_case c ON c.study_id = s.id;
DROP VIEW job_log;
CREATE VIEW job_log AS
    SELECT s.public AS study, j.case_number AS "case", j.id AS job, j.first, j.count, j.state, j.worker,
           j.host, j.attempts, j.seconds, j.error, j.claimed, j.ended, j.cpu_seconds
    FROM job j JOIN study s ON s.id = j.study_id;

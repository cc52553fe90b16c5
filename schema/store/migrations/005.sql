-- How the cases of a study draw random numbers: all alike, or each of its own. The number of the
-- case was in the key of every study of before, which goes on as it began.
ALTER TABLE study ADD COLUMN random TEXT NOT NULL DEFAULT 'independent'
    CHECK (random IN ('common', 'independent'));
DROP VIEW study_progress;
CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, cases * realisations AS realisations,
           round(100.0 * realisations_done / (cases * realisations), 1) AS percent, seconds, created, finished,
           random
    FROM study;

-- The queue of a group. An owner is the name of a token; '' has what was submitted without.
ALTER TABLE study ADD COLUMN owner TEXT NOT NULL DEFAULT '';
ALTER TABLE study ADD COLUMN priority INTEGER NOT NULL DEFAULT 0; -- among those of its owner
ALTER TABLE study ADD COLUMN work REAL NOT NULL DEFAULT 0;        -- seconds of all jobs, as estimated
UPDATE study SET work = (SELECT total(c.estimate * coalesce(c.realisations, study.realisations))
                         FROM study_case c WHERE c.study_id = study.id AND (c.parent IS NOT NULL OR study.realisations > 0));
DROP INDEX study_open;
CREATE INDEX study_line ON study(owner, priority DESC, id) WHERE state IN ('queued', 'running');
-- What each owner has had of the workers, as seconds of claimed jobs over its weight. Who has had
-- least is next; who comes back after a pause begins where the others are.
CREATE TABLE share (
    owner TEXT PRIMARY KEY,
    weight REAL NOT NULL DEFAULT 1 CHECK (weight > 0),
    begun REAL NOT NULL DEFAULT 0,         -- when the last job that was claimed began, on that clock
    served REAL NOT NULL DEFAULT 0         -- and when it is through
) WITHOUT ROWID;
INSERT INTO share (owner) VALUES ('');

DROP VIEW study_progress;
CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, total AS realisations,
           round(100.0 * realisations_done / total, 1) AS percent, seconds, created, finished, random,
           cpu_seconds, jobs_without_cpu, error_reached, seed, program, owner, priority
    FROM (SELECT *, CASE WHEN realisations > 0 THEN cases * realisations ELSE
              (SELECT sum(c.realisations) FROM study_case c WHERE c.study_id = study.id) END AS total,
              (SELECT max(c.error_reached) FROM study_case c WHERE c.study_id = study.id) AS error_reached
          FROM study WHERE id NOT IN (SELECT id FROM deleted_study WHERE purged = 0));

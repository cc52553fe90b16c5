-- A waiting row of job is a span: realisations of a case, however many, off whose front a claim cuts
-- the block that it leases. What was queued before waits as it was cut then.
-- A job ends after three attempts that failed, or after ten that were lost with their workers.
-- The token of a lease is kept as a digest alone; lease_digest is the program's.
ALTER TABLE job ADD COLUMN blocks INTEGER NOT NULL DEFAULT 1;     -- jobs that it counts as: of a span those that it is to be cut into
ALTER TABLE job ADD COLUMN losses INTEGER NOT NULL DEFAULT 0;     -- leases that ran out; no attempts
ALTER TABLE job ADD COLUMN not_before INTEGER NOT NULL DEFAULT 0; -- it waits until then after a loss, on the clock of leases
ALTER TABLE study_case ADD COLUMN block INTEGER;                  -- the most realisations of a job; NULL: of an older program
ALTER TABLE study ADD COLUMN realisations_waiting INTEGER NOT NULL DEFAULT 0; -- of its waiting jobs
UPDATE study SET realisations_waiting = (SELECT coalesce(sum(j.count), 0) FROM job j WHERE j.study_id = study.id AND j.state = 'waiting');
PRAGMA secure_delete = ON; -- what was a token is overwritten
UPDATE job SET token = CASE WHEN state = 'running' THEN lease_digest(token) END WHERE token IS NOT NULL;
-- By case and number: a span keeps its place when its front is cut off.
DROP INDEX job_waiting;
CREATE INDEX job_waiting ON job(study_id, case_number, id) WHERE state = 'waiting';
-- Workers that asked for jobs of late, among whom few jobs are to be divided.
CREATE TABLE seen (
    worker TEXT PRIMARY KEY,
    threads INTEGER NOT NULL,
    at INTEGER NOT NULL                    -- when it last asked, nearly, on the clock of leases
) WITHOUT ROWID;

DROP VIEW job_log;
CREATE VIEW job_log AS
    SELECT s.public AS study, j.case_number AS "case", j.id AS job, j.first, j.count, j.state, j.worker,
           j.host, j.attempts, j.seconds, j.error, j.claimed, j.ended, j.cpu_seconds, j.program, j.losses
    FROM job j JOIN study s ON s.id = j.study_id;

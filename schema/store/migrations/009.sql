-- Which program queued a study and which computed each of its jobs, as VERSION+COMMIT, and what the
-- realisations of a case have at each point of its curves.
ALTER TABLE study ADD COLUMN program TEXT;      -- NULL: not known, of an older program
ALTER TABLE job ADD COLUMN program TEXT;        -- of the worker that claimed it last; NULL: likewise
CREATE TABLE point_realisations (
    curve_id INTEGER NOT NULL REFERENCES curve(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,                    -- of the point
    y TEXT NOT NULL,                            -- [...], of each realisation from 0 on, or null
    PRIMARY KEY (curve_id, number)
) WITHOUT ROWID;

DROP VIEW study_progress;
CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, total AS realisations,
           round(100.0 * realisations_done / total, 1) AS percent, seconds, created, finished, random,
           cpu_seconds, jobs_without_cpu, error_reached, seed, program
    FROM (SELECT *, CASE WHEN realisations > 0 THEN cases * realisations ELSE
              (SELECT sum(c.realisations) FROM study_case c WHERE c.study_id = study.id) END AS total,
              (SELECT max(c.error_reached) FROM study_case c WHERE c.study_id = study.id) AS error_reached
          FROM study);
DROP VIEW job_log;
CREATE VIEW job_log AS
    SELECT s.public AS study, j.case_number AS "case", j.id AS job, j.first, j.count, j.state, j.worker,
           j.host, j.attempts, j.seconds, j.error, j.claimed, j.ended, j.cpu_seconds, j.program
    FROM job j JOIN study s ON s.id = j.study_id;
-- Where and when the results of a study were computed, and by which programs.
CREATE VIEW study_runs AS
    SELECT s.public AS study, j.host, j.program, count(*) AS jobs, min(j.claimed) AS first,
           max(j.ended) AS last
    FROM job j JOIN study s ON s.id = j.study_id WHERE j.state = 'done'
    GROUP BY j.study_id, j.host, j.program;
-- A row a parameter, by its pointer: numbers and words as they are, lists whole as JSON. The names
-- of parameters have neither dots nor quotes, which SQLite puts around those with an underscore.
CREATE VIEW case_parameters AS
    SELECT s.public AS study, c.number AS "case", replace(replace(substr(p.fullkey, 2), '"', ''), '.', '/') AS name, p.value
    FROM study s JOIN study_case c ON c.study_id = s.id, json_tree(c.parameters) p
    WHERE c.parent IS NULL AND p.type <> 'object' AND typeof(p.key) = 'text';
-- What single realisations have at the points of a curve that is their mean.
CREATE VIEW realisation_points AS
    SELECT s.public AS study, c.case_number AS "case", r.key AS realisation, c.quantity, c.series, c.model,
           c.kinematics, c.level, p.x, r.value AS y
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id
    JOIN point_realisations v ON v.curve_id = p.curve_id AND v.number = p.number, json_each(v.y) r
    WHERE r.type <> 'null';

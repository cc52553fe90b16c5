-- What the migrations make of an empty file, for a new store. tests/unit/schema/test_store_versions.c compares both, and
-- prints what this file must be. Columns that were added stand before the comment of the last one: "rises with every
-- block" is of study_case.revision, "realisations that y is not over" of point.valueless.
CREATE TABLE study (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    public TEXT NOT NULL UNIQUE,           -- what people call it
    name TEXT NOT NULL,
    kind TEXT NOT NULL,
    seed TEXT NOT NULL,                    -- decimal: 64 unsigned bits
    realisations INTEGER NOT NULL,         -- of each case
    submit_key TEXT UNIQUE,
    state TEXT NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'cancelled')),
    cases INTEGER NOT NULL,
    jobs INTEGER NOT NULL,
    jobs_waiting INTEGER NOT NULL,         -- these five add up to jobs
    jobs_running INTEGER NOT NULL DEFAULT 0,
    jobs_done INTEGER NOT NULL DEFAULT 0,
    jobs_failed INTEGER NOT NULL DEFAULT 0,
    jobs_cancelled INTEGER NOT NULL DEFAULT 0,
    realisations_done INTEGER NOT NULL DEFAULT 0,
    realisations_failed INTEGER NOT NULL DEFAULT 0,
    seconds REAL NOT NULL DEFAULT 0,       -- spent by completed jobs
    revision INTEGER NOT NULL DEFAULT 1,   -- rises with every change
    created TEXT NOT NULL,
    finished TEXT
, cases_failed INTEGER NOT NULL DEFAULT 0, random TEXT NOT NULL DEFAULT 'independent'
    CHECK (random IN ('common', 'independent')), cpu_seconds REAL NOT NULL DEFAULT 0, jobs_without_cpu INTEGER NOT NULL DEFAULT 0, program TEXT, digest INTEGER, edition INTEGER, owner TEXT NOT NULL DEFAULT '', priority INTEGER NOT NULL DEFAULT 0, work REAL NOT NULL DEFAULT 0, realisations_waiting INTEGER NOT NULL DEFAULT 0, asked INTEGER);
CREATE TABLE study_source (
    study_id INTEGER PRIMARY KEY REFERENCES study(id) ON DELETE CASCADE,
    source TEXT NOT NULL                   -- the document as it was given
, seal INTEGER);
CREATE TABLE study_case (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,
    parameters TEXT NOT NULL,              -- effective values, JSON
    estimate REAL NOT NULL,                -- seconds a realisation, before anything ran
    jobs INTEGER NOT NULL,
    jobs_left INTEGER NOT NULL,            -- neither done, failed nor cancelled
    realisations_done INTEGER NOT NULL DEFAULT 0,
    seconds REAL NOT NULL DEFAULT 0,
    revision INTEGER NOT NULL DEFAULT 0, settled INTEGER NOT NULL DEFAULT 0, publish_error TEXT, cpu_seconds REAL NOT NULL DEFAULT 0, jobs_without_cpu INTEGER NOT NULL DEFAULT 0, parent INTEGER, role TEXT, sequence INTEGER, realisations INTEGER, result_bytes REAL, error_reached REAL, seal INTEGER, block INTEGER,   -- rises with every block
    PRIMARY KEY (study_id, number)
) WITHOUT ROWID;
CREATE TABLE job (
    id INTEGER PRIMARY KEY,
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    first INTEGER NOT NULL,                -- realisations first .. first + count - 1
    count INTEGER NOT NULL,
    state TEXT NOT NULL DEFAULT 'waiting'
        CHECK (state IN ('waiting', 'running', 'done', 'failed', 'cancelled')),
    attempts INTEGER NOT NULL DEFAULT 0,   -- claims that counted
    token TEXT,                            -- fence of the last lease
    lease_until INTEGER,
    reported INTEGER NOT NULL DEFAULT 0,   -- realisations, by the last heartbeat
    worker TEXT,
    host TEXT,
    seconds REAL,
    error TEXT,                            -- why the last failed attempt failed
    claimed TEXT,
    ended TEXT
, cpu_seconds REAL, program TEXT, claimed_ms INTEGER, reported_ms INTEGER NOT NULL DEFAULT 0, blocks INTEGER NOT NULL DEFAULT 1, losses INTEGER NOT NULL DEFAULT 0, not_before INTEGER NOT NULL DEFAULT 0);
CREATE INDEX job_lease ON job(lease_until) WHERE state = 'running';
CREATE INDEX job_case ON job(study_id, case_number, first);
CREATE TABLE boot (id TEXT NOT NULL);
CREATE TABLE result (
    job_id INTEGER PRIMARY KEY REFERENCES job(id) ON DELETE CASCADE,
    names_id INTEGER NOT NULL,             -- of scalar_names
    scalars TEXT NOT NULL,                 -- [[...], ...], a row a realisation
    data BLOB NOT NULL                     -- the kind's accumulators
, seal INTEGER);
CREATE TABLE scalar_names (
    id INTEGER PRIMARY KEY,
    names TEXT NOT NULL UNIQUE             -- ["skewness", ...]
);
CREATE TABLE published (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    revision INTEGER NOT NULL,             -- of study_case when it was merged
    document TEXT NOT NULL, report TEXT, curves_seal INTEGER, rows_seal INTEGER, seal INTEGER, valueless INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY (study_id, case_number)
);
CREATE TABLE scalar (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    name TEXT NOT NULL,
    value REAL,
    standard_error REAL,
    theory REAL, grid_theory REAL, law_difference REAL, law_standard_error REAL, total_low REAL, total_high REAL, unknown_errors TEXT,
    PRIMARY KEY (study_id, case_number, name)
) WITHOUT ROWID;
CREATE TABLE curve (
    id INTEGER PRIMARY KEY,
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    quantity TEXT NOT NULL,
    series TEXT NOT NULL,
    model TEXT,
    kinematics TEXT,                       -- of strain: of the model full alone
    level REAL,
    pressure REAL
, data BLOB);
CREATE INDEX curve_case ON curve(study_id, case_number, quantity);
CREATE TABLE point (
    curve_id INTEGER NOT NULL REFERENCES curve(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,
    x REAL,
    x2 REAL,                               -- second abscissa of a matrix
    y REAL,
    standard_error REAL,
    discretisation_error REAL,
    model_error REAL,
    valueless INTEGER, law_difference REAL, law_standard_error REAL, total_low REAL, total_high REAL, unknown_errors TEXT,                     -- realisations that y is not over; null: of none told
    PRIMARY KEY (curve_id, number)
) WITHOUT ROWID;
CREATE INDEX case_due ON study_case(study_id, number) WHERE jobs_left = 0 AND revision > settled;
CREATE VIEW case_notes AS
    SELECT s.public AS study, p.case_number AS "case", n.value ->> 'realisation' AS realisation,
           n.value ->> 'text' AS note
    FROM study s JOIN published p ON p.study_id = s.id, json_each(p.document, '$.notes.kept') n;
CREATE TABLE point_error (
    curve_id INTEGER NOT NULL REFERENCES curve(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,                    -- of the point
    source TEXT NOT NULL,                       -- "discretisation", "model", ...
    value REAL,
    standard_error REAL, bound REAL,
    PRIMARY KEY (curve_id, number, source)
) WITHOUT ROWID;
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
CREATE VIEW curve_errors AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, c.model, c.kinematics,
           c.level, c.pressure, p.x, e.source, e.value, e.bound, e.standard_error
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id
    JOIN point_error e ON e.curve_id = p.curve_id AND e.number = p.number;
CREATE INDEX case_parent ON study_case(study_id, parent) WHERE parent IS NOT NULL;
CREATE VIEW case_progress AS
    SELECT s.public AS study, c.number AS "case",
           CASE WHEN c.jobs_left > 0 THEN 'open' WHEN c.revision = 0 THEN 'empty'
                WHEN c.revision > c.settled THEN 'due' WHEN c.publish_error IS NULL THEN 'published'
                ELSE 'failed' END AS state,
           c.jobs, c.jobs_left, c.realisations_done, coalesce(c.realisations, s.realisations) AS realisations,
           c.seconds, c.publish_error AS error, c.cpu_seconds, c.jobs_without_cpu, c.error_reached
    FROM study s JOIN study_case c ON c.study_id = s.id WHERE c.parent IS NULL;
CREATE VIEW case_components AS
    SELECT s.public AS study, c.parent AS "case", c.number AS component, c.role, c.realisations,
           c.realisations_done, c.jobs, c.jobs_left, c.seconds, c.cpu_seconds, c.parameters
    FROM study s JOIN study_case c ON c.study_id = s.id WHERE c.parent IS NOT NULL;
CREATE TABLE point_realisations (
    curve_id INTEGER NOT NULL REFERENCES curve(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,                    -- of the point
    y TEXT NOT NULL,                            -- [...], of each realisation from 0 on, or null
    PRIMARY KEY (curve_id, number)
) WITHOUT ROWID;
CREATE VIEW study_runs AS
    SELECT s.public AS study, j.host, j.program, count(*) AS jobs, min(j.claimed) AS first,
           max(j.ended) AS last
    FROM job j JOIN study s ON s.id = j.study_id WHERE j.state = 'done'
    GROUP BY j.study_id, j.host, j.program;
CREATE VIEW realisation_points AS
    SELECT s.public AS study, c.case_number AS "case", r.key AS realisation, c.quantity, c.series, c.model,
           c.kinematics, c.level, p.x, r.value AS y
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id
    JOIN point_realisations v ON v.curve_id = p.curve_id AND v.number = p.number, json_each(v.y) r
    WHERE r.type <> 'null';
CREATE INDEX study_digest ON study(digest) WHERE digest IS NOT NULL;
CREATE TABLE deleted_study (
    id INTEGER PRIMARY KEY,               -- of study
    public TEXT NOT NULL UNIQUE,          -- what people called it
    deleted TEXT NOT NULL,
    purged INTEGER NOT NULL DEFAULT 0
);
CREATE INDEX study_purge ON deleted_study(id) WHERE purged = 0;
CREATE TABLE share (
    owner TEXT PRIMARY KEY,
    weight REAL NOT NULL DEFAULT 1 CHECK (weight > 0),
    begun REAL NOT NULL DEFAULT 0,         -- when the last job that was claimed began, on that clock
    served REAL NOT NULL DEFAULT 0         -- and when it is through
) WITHOUT ROWID;
CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, total AS realisations,
           round(100.0 * realisations_done / total, 1) AS percent, seconds, created, finished, random,
           cpu_seconds, jobs_without_cpu, error_reached, seed, program, owner, priority
    FROM (SELECT *, CASE WHEN realisations > 0 THEN cases * realisations ELSE
              (SELECT sum(c.realisations) FROM study_case c WHERE c.study_id = study.id) END AS total,
              (SELECT max(c.error_reached) FROM study_case c WHERE c.study_id = study.id) AS error_reached
          FROM study WHERE id NOT IN (SELECT id FROM deleted_study WHERE purged = 0));
CREATE INDEX job_ended ON job(ended) WHERE state = 'done';
CREATE INDEX job_waiting ON job(study_id, case_number, id) WHERE state = 'waiting';
CREATE TABLE seen (
    worker TEXT PRIMARY KEY,
    threads INTEGER NOT NULL,
    at INTEGER NOT NULL                    -- when it last asked, nearly, on the clock of leases
) WITHOUT ROWID;
CREATE VIEW job_log AS
    SELECT s.public AS study, j.case_number AS "case", j.id AS job, j.first, j.count, j.state, j.worker,
           j.host, j.attempts, j.seconds, j.error, j.claimed, j.ended, j.cpu_seconds, j.program, j.losses
    FROM job j JOIN study s ON s.id = j.study_id;
CREATE VIEW case_scalars AS
    SELECT s.public AS study, c.case_number AS "case", c.name AS scalar, c.value, c.standard_error, c.total_low,
           c.total_high, c.unknown_errors, c.theory, c.grid_theory, c.law_difference, c.law_standard_error
    FROM scalar c JOIN study s ON s.id = c.study_id;
CREATE VIEW scalar_errors AS
    SELECT s.public AS study, e.case_number AS "case", e.name AS scalar, e.source, e.value, e.bound, e.standard_error
    FROM study s JOIN scalar_error e ON e.study_id = s.id;
CREATE VIEW curve_points AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, p.x, p.y, p.standard_error, p.total_low,
           p.total_high, p.unknown_errors, p.x2, c.model, c.kinematics, c.level, c.pressure,
           coalesce(p.discretisation_error,
                    (SELECT e.value FROM point_error e WHERE e.curve_id = p.curve_id
                     AND e.number = p.number AND e.source = 'discretisation')) AS discretisation_error,
           coalesce(p.model_error,
                    (SELECT e.value FROM point_error e WHERE e.curve_id = p.curve_id
                     AND e.number = p.number AND e.source = 'model')) AS model_error,
           p.valueless, p.law_difference, p.law_standard_error
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id;
CREATE VIEW case_parameters AS
    SELECT s.public AS study, c.number AS "case", replace(replace(substr(p.fullkey, 2), '"', ''), '.', '/') AS parameter,
           p.value
    FROM study s JOIN study_case c ON c.study_id = s.id, json_tree(c.parameters) p
    WHERE c.parent IS NULL AND p.type <> 'object' AND typeof(p.key) = 'text';
CREATE VIEW realisation_scalars AS
    SELECT s.public AS study, j.case_number AS "case", j.first + one.key AS realisation, n.value AS scalar,
           json_extract(one.value, '$[' || n.key || ']') AS value
    FROM study s JOIN job j ON j.study_id = s.id JOIN result r ON r.job_id = j.id
    JOIN scalar_names names ON names.id = r.names_id, json_each(r.scalars) one, json_each(names.names) n;
CREATE VIEW case_table AS
    SELECT p.study, s.name, p."case", p.state, p.realisations_done, c.parameters,
           (SELECT json_group_object(r.name, r.value) FROM scalar r
            WHERE r.study_id = s.id AND r.case_number = c.number) AS scalars
    FROM case_progress p JOIN study s ON s.public = p.study
    JOIN study_case c ON c.study_id = s.id AND c.number = p."case";
CREATE INDEX published_valueless ON published(study_id, case_number) WHERE valueless;
CREATE INDEX job_running ON job(study_id, case_number) WHERE state = 'running';
CREATE INDEX study_queued ON study(owner, priority DESC, id, state, realisations_done, seconds, realisations_waiting, work, jobs, jobs_waiting)
    WHERE state = 'queued';
CREATE INDEX study_line ON study(owner, priority DESC, id, state) WHERE state IN ('queued', 'running');
INSERT INTO share VALUES ('', 1.0, 0.0, 0.0);

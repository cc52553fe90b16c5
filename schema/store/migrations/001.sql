-- Version 1. Times for people are UTC texts; leases run on the boot clock, in milliseconds.
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
);
CREATE INDEX study_open ON study(id) WHERE state IN ('queued', 'running');
-- Apart, because the counters of a study change with every job.
CREATE TABLE study_source (
    study_id INTEGER PRIMARY KEY REFERENCES study(id) ON DELETE CASCADE,
    source TEXT NOT NULL                   -- the document as it was given
);

CREATE TABLE study_case (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    number INTEGER NOT NULL,
    parameters TEXT NOT NULL,              -- effective values, JSON
    estimate REAL NOT NULL,                -- seconds a realisation, before anything ran
    jobs INTEGER NOT NULL,
    jobs_left INTEGER NOT NULL,            -- neither done, failed nor cancelled
    realisations_done INTEGER NOT NULL DEFAULT 0,
    seconds REAL NOT NULL DEFAULT 0,
    revision INTEGER NOT NULL DEFAULT 0,   -- rises with every block
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
);
CREATE INDEX job_waiting ON job(study_id, id) WHERE state = 'waiting';
CREATE INDEX job_lease ON job(lease_until) WHERE state = 'running';
CREATE INDEX job_case ON job(study_id, case_number, first);
-- The boot on whose clock the leases run, one row: leases of another are void (lease_until 0).
CREATE TABLE boot (id TEXT NOT NULL);

-- Written once, and never with what changes: a job's state does not rewrite its result.
CREATE TABLE result (
    job_id INTEGER PRIMARY KEY REFERENCES job(id) ON DELETE CASCADE,
    names_id INTEGER NOT NULL,             -- of scalar_names
    scalars TEXT NOT NULL,                 -- [[...], ...], a row a realisation
    data BLOB NOT NULL                     -- the kind's accumulators
);
CREATE TABLE scalar_names (
    id INTEGER PRIMARY KEY,
    names TEXT NOT NULL UNIQUE             -- ["skewness", ...]
);

CREATE TABLE published (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    revision INTEGER NOT NULL,             -- of study_case when it was merged
    document TEXT NOT NULL,
    PRIMARY KEY (study_id, case_number)
);
CREATE TABLE scalar (
    study_id INTEGER NOT NULL REFERENCES study(id) ON DELETE CASCADE,
    case_number INTEGER NOT NULL,
    name TEXT NOT NULL,
    value REAL,
    standard_error REAL,
    theory REAL,
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
);
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
    valueless INTEGER,                     -- realisations that y is not over; null: of none told
    PRIMARY KEY (curve_id, number)
) WITHOUT ROWID;

CREATE VIEW study_progress AS
    SELECT public AS study, name, kind, state, cases, jobs, jobs_waiting, jobs_running, jobs_done,
           jobs_failed, jobs_cancelled, realisations_done, cases * realisations AS realisations,
           round(100.0 * realisations_done / (cases * realisations), 1) AS percent, seconds, created, finished
    FROM study;
CREATE VIEW case_scalars AS
    SELECT s.public AS study, c.case_number AS "case", c.name, c.value, c.standard_error, c.theory
    FROM scalar c JOIN study s ON s.id = c.study_id;
CREATE VIEW curve_points AS
    SELECT s.public AS study, c.case_number AS "case", c.quantity, c.series, p.x, p.y, p.standard_error,
           p.x2, c.model, c.kinematics, c.level, c.pressure, p.discretisation_error, p.model_error,
           p.valueless
    FROM study s JOIN curve c ON c.study_id = s.id JOIN point p ON p.curve_id = c.id;
-- The first notes of a case (jobs/notes.h), as published.
CREATE VIEW case_notes AS
    SELECT s.public AS study, p.case_number AS "case", n.value ->> 'realisation' AS realisation,
           n.value ->> 'text' AS note
    FROM study s JOIN published p ON p.study_id = s.id, json_each(p.document, '$.notes.kept') n;
CREATE VIEW realisation_scalars AS
    SELECT s.public AS study, j.case_number AS "case", j.first + one.key AS realisation,
           (SELECT json_group_object(n.value, one.value -> ('$[' || n.key || ']'))
            FROM json_each(names.names) n) AS scalars
    FROM study s JOIN job j ON j.study_id = s.id JOIN result r ON r.job_id = j.id
    JOIN scalar_names names ON names.id = r.names_id, json_each(r.scalars) one;
CREATE VIEW job_log AS
    SELECT s.public AS study, j.case_number AS "case", j.id AS job, j.first, j.count, j.state, j.worker,
           j.host, j.attempts, j.seconds, j.error, j.claimed, j.ended
    FROM job j JOIN study s ON s.id = j.study_id;

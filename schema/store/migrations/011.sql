-- When a running job was claimed, on the clock of leases, and how long after that its last report of
-- more realisations was: what these take is known before the job has ended.
ALTER TABLE job ADD COLUMN claimed_ms INTEGER;
ALTER TABLE job ADD COLUMN reported_ms INTEGER NOT NULL DEFAULT 0;
